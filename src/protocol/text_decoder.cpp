#include "protocol/text_decoder.h"

#include <algorithm>
#include <array>
#include <optional>

#include "fsr_pressure_map/settings/input_error.h"

namespace fsr::protocol {
namespace {

// More than a sketch needs for a number with its separator and blanks, and for the names of a short header.
constexpr std::size_t kBytesForANumber = 16;
constexpr std::size_t kBytesForALine = 256;
constexpr std::int64_t kLongestDeviation = 4'000'000;  // of a trigger [ticks]: fits 32 bits of us
constexpr std::size_t kDigits = 18;                    // a number of that many fits 64 bits

bool isBlank(char c) {
  return c == ' ' || c == '\t';
}

bool isDigit(char c) {
  return c >= '0' && c <= '9';
}

bool isAscii(std::uint8_t byte) {
  return (byte >= ' ' && byte <= '~') || byte == '\t' || byte == '\r';
}

// What a name in a header, or a greeting of a sketch, begins with.
bool beginsAWord(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || c == '"';
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && isBlank(text.front())) text.remove_prefix(1);
  while (!text.empty() && isBlank(text.back())) text.remove_suffix(1);
  return text;
}

// Comma or semicolon where the line has one, else tab, else space.
char separatorOf(std::string_view line) {
  const std::size_t mark = line.find_first_of(",;");
  if (mark != std::string_view::npos) return line[mark];
  return line.find('\t') != std::string_view::npos ? '\t' : ' ';
}

// Removes the first field from `line`. Blanks around a field do not count.
std::string_view takeField(std::string_view& line, char separator) {
  const std::size_t end = std::min(line.find(separator), line.size());
  const std::string_view field = trimmed(line.substr(0, end));
  line = trimmed(line.substr(std::min(end + 1, line.size())));
  return field;
}

std::optional<std::int64_t> toNumber(std::string_view field) {
  const bool negative = !field.empty() && field.front() == '-';
  if (negative) field.remove_prefix(1);
  if (field.empty() || field.size() > kDigits || !std::all_of(field.begin(), field.end(), isDigit)) {
    return std::nullopt;
  }
  std::int64_t number = 0;
  for (const char digit : field) number = 10 * number + (digit - '0');
  return negative ? -number : number;
}

bool isReading(std::int64_t number) {
  return number == static_cast<std::int32_t>(number);
}

}  // namespace

TextDecoder::TextDecoder(PacketHandler& handler, const DecoderOptions& options)
    : handler_(handler), options_(options) {
  const std::size_t taxels = options.size.taxels();
  if (taxels == 0) {
    throw settings::InputError(
        "the protocol text needs the number of rows and of columns: a line of counts does not say them");
  }
  numbers_.resize(1 + taxels + (options.transducer ? 1 : 0));
  line_.resize(kBytesForALine + kBytesForANumber * numbers_.size());
  scan_counts_.resize(taxels);
}

void TextDecoder::feed(const std::uint8_t* bytes, std::size_t size) {
  counts_.bytes += size;
  std::for_each(bytes, bytes + size, [this](std::uint8_t byte) { take(byte); });
}

void TextDecoder::finish() {
  if (length_ > 0 && (state_ == State::kCut || state_ == State::kReading)) {
    ++counts_.lines.cut;
    if (state_ == State::kReading) counts_.skipped_bytes += length_;
  }
  state_ = State::kCut;
  length_ = 0;
  damaged_ = 0;
}

void TextDecoder::take(std::uint8_t byte) {
  if (state_ == State::kCut || state_ == State::kDropped) ++counts_.skipped_bytes;
  ++length_;
  if (byte == '\n') return endLine();
  if (length_ == 1 && byte == '#' && state_ == State::kReading) state_ = State::kComment;
  const bool fits = length_ <= line_.size();
  if (state_ == State::kReading && !isAscii(byte)) {
    drop(counts_.lines.not_ascii);
  } else if (state_ == State::kReading && !fits) {
    drop(counts_.lines.too_long);
  } else if (fits) {
    line_[length_ - 1] = static_cast<char>(byte);
  }
}

void TextDecoder::endLine() {
  if (state_ == State::kCut) ++counts_.lines.cut;
  if (state_ == State::kComment) {
    ++counts_.lines.without_numbers;
    readComment({line_.data(), std::min(length_ - 1, line_.size())});
  }
  if (state_ == State::kReading) read({line_.data(), length_ - 1});
  state_ = State::kReading;
  length_ = 0;
}

void TextDecoder::read(std::string_view line) {
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  line = trimmed(line);
  const bool words = line.empty() || beginsAWord(line.front());
  const char separator = separatorOf(line);
  std::size_t numbers = 0, others = 0;
  bool sign = false;       // before a time or a count, -0 too
  while (!line.empty()) {  // so one separator behind the last field is none too many
    const std::string_view field = takeField(line, separator);
    const std::optional<std::int64_t> number = toNumber(field);
    sign |= number && field.front() == '-' && numbers <= scan_counts_.size();
    if (number && numbers < numbers_.size()) numbers_[numbers] = *number;
    ++(number ? numbers : others);
  }
  if (words && numbers == 0) {
    ++counts_.lines.without_numbers;
  } else if (others > 0) {
    drop(counts_.lines.not_numbers);
  } else if (isScan(numbers, sign)) {
    deliver();
  }
}

// Whether the numbers of a line are a scan; counts the cause where they are not.
bool TextDecoder::isScan(std::size_t numbers, bool sign) {
  LineCounts& lines = counts_.lines;
  if (numbers != numbers_.size()) {
    lines.last_number = numbers - 1;
    return refuse(lines.wrong_number);
  }
  const auto taxels = static_cast<std::ptrdiff_t>(scan_counts_.size());
  const auto end = numbers_.begin() + 1 + taxels;
  if (sign) return drop(lines.not_numbers);
  if (options_.transducer && !isReading(numbers_.back())) return drop(lines.not_numbers);
  const std::int64_t highest = *std::max_element(numbers_.begin() + 1, end);
  if (highest <= options_.full_scale) return true;
  lines.highest_count = std::max(lines.highest_count, static_cast<std::uint64_t>(highest));
  return refuse(lines.above_full_scale);
}

void TextDecoder::deliver() {
  SequenceCounts& scans = counts_.of(PacketType::kScan);
  if (damaged_ > 0) ++scans.gaps;
  scans.lost += damaged_;
  ++scans.packets;
  sequence_ += 1 + damaged_;
  damaged_ = 0;
  for (std::size_t i = 0; i < scan_counts_.size(); ++i) {
    scan_counts_[i] = static_cast<std::uint16_t>(numbers_[i + 1]);
  }
  // Where a counter of 32 bits or more wraps, this one continues, because 2^32 ticks are 0 modulo 2^32 us.
  const auto time = static_cast<std::uint32_t>(numbers_.front()) * options_.tick;
  const PacketHeader header = {sequence_, time, length_};
  handler_.onScan(header, {options_.size, options_.full_scale, 0, scan_counts_.data()});
  if (!options_.transducer) return;
  ++counts_.of(PacketType::kTransducer).packets;
  handler_.onTransducer(header, static_cast<std::int32_t>(numbers_.back()));
}

// `#trigger,TIME,HIGH,DEVIATION`, times in ticks. Every other comment is passed over.
void TextDecoder::readComment(std::string_view line) {
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  if (takeField(line, ',') != "#trigger") return;
  std::array<std::int64_t, 3> fields{};
  for (std::int64_t& field : fields) {
    const std::optional<std::int64_t> number = toNumber(takeField(line, ','));
    if (!number || *number < 0) return;
    field = *number;
  }
  const auto [time, high, deviation] = fields;
  if (!line.empty() || high > 1 || deviation > kLongestDeviation) return;
  ++counts_.of(PacketType::kTrigger).packets;
  handler_.onTrigger({++triggers_, static_cast<std::uint32_t>(time) * options_.tick, length_},
                     {high == 1, static_cast<std::uint32_t>(deviation) * options_.tick});
}

// A line that looks like noise. False, as refuse().
bool TextDecoder::drop(std::uint64_t& cause) {
  ++cause;
  ++damaged_;
  counts_.skipped_bytes += length_;
  state_ = State::kDropped;
  return false;
}

// A line of numbers that are not those of this matrix.
bool TextDecoder::refuse(std::uint64_t& cause) {
  ++cause;
  ++damaged_;
  ++counts_.bad_content;
  return false;
}

}  // namespace fsr::protocol
