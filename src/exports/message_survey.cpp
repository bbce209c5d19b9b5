#include "exports/message_survey.h"

#include <algorithm>
#include <cstring>
#include <string>

namespace fsr::exports {

namespace {

constexpr std::int64_t kSecond = 1000000000;  // [ns]

template <typename T>
T number(const char* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof(value));
  return value;
}

bool isTime(Scalar scalar) {
  return scalar == Scalar::kTime || scalar == Scalar::kDuration;
}

}  // namespace

std::int64_t nanosecondsOf(Scalar scalar, const char* bytes, bool& usual) {
  const std::int64_t rest = scalar == Scalar::kTime ? std::int64_t{number<std::uint32_t>(bytes + 4)}
                                                    : std::int64_t{number<std::int32_t>(bytes + 4)};
  const std::int64_t seconds = scalar == Scalar::kTime ? std::int64_t{number<std::uint32_t>(bytes)}
                                                       : std::int64_t{number<std::int32_t>(bytes)};
  usual = rest >= 0 && rest < kSecond;
  return seconds * kSecond + rest;
}

void timeBytes(Scalar scalar, std::int64_t nanoseconds, char* bytes) {
  const std::int64_t rest = (nanoseconds % kSecond + kSecond) % kSecond;
  const std::int64_t seconds = (nanoseconds - rest) / kSecond;
  const auto low = static_cast<std::uint32_t>(rest);
  // The seconds of a duration are signed, but have the same bytes as unsigned ones.
  const auto high =
      scalar == Scalar::kTime ? static_cast<std::uint32_t>(seconds) : std::uint32_t(std::int32_t(seconds));
  std::memcpy(bytes, &high, sizeof(high));
  std::memcpy(bytes + 4, &low, sizeof(low));
}

struct MessageSurvey::Look {
  MessageSurvey& survey;

  void note(const MessageField& field, std::uint32_t value) {
    Seen& seen = survey.seen_[field.id];
    seen.least = seen.any ? std::min(seen.least, value) : value;
    seen.most = seen.any ? std::max(seen.most, value) : value;
    seen.any = true;
  }
  void count(const MessageField& field, std::uint32_t n) { note(field, n); }
  void values(const MessageField& field, const char* bytes, std::size_t n) {
    if (field.scalar == Scalar::kUint16 && field.count == MessageField::Count::kOne) {
      note(field, number<std::uint16_t>(bytes));
    }
    for (std::size_t i = 0; isTime(field.scalar) && i < n; ++i) {
      bool usual = false;
      nanosecondsOf(field.scalar, bytes + 8 * i, usual);
      survey.plain_ &= usual;
    }
  }
  void text(const MessageField& field, std::string_view text) {
    Seen& seen = survey.seen_[field.id];
    seen.longest = std::max(seen.longest, text.size());
    survey.plain_ &= text.size() <= kLongestText && text.find('\0') == std::string_view::npos;
  }
};

MessageSurvey::MessageSurvey(const MessageType& type) : type_(type), seen_(type.count) {}

void MessageSurvey::look(std::string_view bytes) {
  Look look{*this};
  plain_ &= visitMessage(type_, bytes, look);
}

std::optional<std::size_t> MessageSurvey::lengthOf(const MessageField& field) const {
  const Seen& seen = seen_[field.id];
  if (field.repeated || seen.least != seen.most) return {};
  return seen.least;
}

std::optional<std::size_t> MessageSurvey::constant(const std::string& name) const {
  for (const MessageField& field : type_.fields) {
    const Seen& seen = seen_[field.id];
    if (field.name != name || field.nested || field.scalar != Scalar::kUint16) continue;
    if (field.count == MessageField::Count::kOne && seen.any && seen.least == seen.most) return seen.least;
  }
  return {};
}

}  // namespace fsr::exports
