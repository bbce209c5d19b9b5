#include "dataset/table_reader.h"

#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstring>
#include <locale>
#include <numeric>
#include <sstream>
#include <string_view>

#include "settings/regular_file.h"

namespace fsr::dataset {

namespace {

constexpr std::size_t kLongestLine = 1 << 20;  // [bytes]: a file with longer lines is not a table
// Empty lines and comments that follow each other [bytes]. A packed file can hold any number of them.
constexpr std::size_t kMostWithoutRow = 1 << 24;

std::string trimmed(const std::string& text) {
  const char* const blank = " \t\r\"";
  const std::size_t first = text.find_first_not_of(blank);
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(blank) - first + 1);
}

// The whole text as a number; `ok` is false where it is not one.
double parsed(std::string text, bool decimal_comma, bool& ok) {
  // 1.234 would be 1234 for some who write decimal commas, and 1.234 for others.
  ok = !decimal_comma || text.find('.') == std::string::npos;
  if (!ok) return NAN;
  if (decimal_comma) std::replace(text.begin(), text.end(), ',', '.');
  std::string lower = text;
  std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) { return std::tolower(c); });
  ok = true;
  if (lower == "inf" || lower == "+inf" || lower == "infinity") return INFINITY;
  if (lower == "-inf" || lower == "-infinity") return -INFINITY;
  if (lower == "nan" || lower == "na") return NAN;
  std::istringstream stream(text);
  stream.imbue(std::locale::classic());
  double value = NAN;
  stream >> value;
  ok = !stream.fail() && stream.peek() == std::istringstream::traits_type::eof();
  return value;
}

// Tab and semicolon cannot be part of a number. A comma can, as a decimal comma.
char separatorOf(const std::string& line, bool decimal_comma) {
  for (const char candidate : {'\t', ';', ','}) {
    if (candidate == ',' && decimal_comma) continue;
    if (line.find(candidate) != std::string::npos) return candidate;
  }
  return ' ';
}

std::vector<std::string> split(const std::string& line, char separator) {
  std::vector<std::string> cells;
  std::istringstream stream(line);
  if (separator == ' ') {
    for (std::string cell; stream >> cell;) cells.push_back(trimmed(cell));
    return cells;
  }
  for (std::string cell; std::getline(stream, cell, separator);) cells.push_back(trimmed(cell));
  if (!line.empty() && line.back() == separator) cells.emplace_back();
  return cells;
}

}  // namespace

struct TableReader::Source {
  gzFile file = nullptr;
  std::string path;
  std::size_t line = 0;

  explicit Source(const std::string& name) : path(name) {
    settings::RegularFile opened(path);
    const int descriptor = opened.release();
    file = gzdopen(descriptor, "rb");
    if (file != nullptr) return;
    close(descriptor);
    throw settings::InputError(path + ": needs more memory than the system gives");
  }
  ~Source() { gzclose(file); }
  Source(const Source&) = delete;
  Source& operator=(const Source&) = delete;

  // A user may give the spreadsheet itself; its bytes would be shown as names of columns.
  void refuseSpreadsheet() const {
    std::array<char, 4> head{};
    const int size = gzread(file, head.data(), head.size());
    gzrewind(file);
    const std::string_view begin(head.data(), size > 0 ? static_cast<std::size_t>(size) : 0);
    if (begin != "PK\x03\x04" && begin != "\xD0\xCF\x11\xE0") return;  // .xlsx and .ods; .xls
    throw settings::InputError(path + ": is a spreadsheet or an archive, but must be text; save it as CSV");
  }

  // Spreadsheets begin UTF-8 with a byte-order mark.
  void removeMark(std::string& text) const {
    if (text.rfind("\xEF\xBB\xBF", 0) == 0) text.erase(0, 3);
    if (text.rfind("\xFF\xFE", 0) == 0 || text.rfind("\xFE\xFF", 0) == 0) {
      throw settings::InputError(path + ": is UTF-16 text, but must be UTF-8 or ASCII; save it as CSV UTF-8");
    }
  }

  bool getLine(std::string& text) {
    text.clear();
    std::array<char, 4096> part{};
    while (gzgets(file, part.data(), static_cast<int>(part.size())) != nullptr) {
      text += part.data();
      if (text.size() > kLongestLine)
        throw settings::InputError(path + ": a line is too long; this is not a text table");
      if (text.empty()) throw settings::InputError(path + ": has a zero byte; this is not a text table");
      if (text.back() == '\n') break;
    }
    int error = Z_OK;
    const char* const why = gzerror(file, &error);
    if (error != Z_OK && error != Z_STREAM_END) {
      throw settings::InputError(path + ", after line " + std::to_string(line) +
                                 ": cannot be read further (" + why + ")");
    }
    if (text.empty()) return false;
    ++line;
    if (line == 1) removeMark(text);
    while (!text.empty() && (text.back() == '\n' || text.back() == '\r')) text.pop_back();
    return true;
  }
};

TableReader::TableReader(const std::string& path, const TableFormat& format)
    : source_(std::make_unique<Source>(path)), path_(path), format_(format) {
  source_->refuseSpreadsheet();
  begin();
}

TableReader::~TableReader() = default;

bool TableReader::readCells() {
  std::string line;
  std::size_t without_row = 0;  // [bytes]
  while (source_->getLine(line)) {
    const std::string content = trimmed(line);
    without_row += line.size() + 1;
    if (source_->line > format_.skip_lines && without_row > kMostWithoutRow) {
      throw settings::InputError(
          path_ + ", line " + std::to_string(source_->line) +
          ": 16 MiB of empty lines and comments follow each other; this is not a table");
    }
    if (source_->line <= format_.skip_lines || content.empty() || content[0] == '#') continue;
    if (format_.separator == 0) format_.separator = separatorOf(line, format_.decimal_comma);
    cells_ = split(line, format_.separator);
    if (!cells_.empty()) return true;  // otherwise the line is white space
  }
  return false;
}

void TableReader::begin() {
  if (!readCells())
    throw settings::InputError(path_ + ": has no row; a text table with one row for each reading is needed");
  columns_ = cells_.size();
  bool is_number = false;
  parsed(cells_[0], format_.decimal_comma, is_number);
  const bool told = format_.header == TableFormat::Header::kTold;
  if (told ? is_number : format_.header == TableFormat::Header::kNo) {
    first_is_pending_ = true;
  } else {
    names_ = cells_;
  }
}

bool TableReader::next() {
  if (first_is_pending_) {
    first_is_pending_ = false;
    return true;
  }
  if (!readCells()) return false;
  if (cells_.size() != columns_) {
    throw settings::InputError(path_ + ", line " + std::to_string(line()) + ": has " +
                               std::to_string(cells_.size()) + " columns, but the first row has " +
                               std::to_string(columns_));
  }
  return true;
}

std::optional<std::size_t> TableReader::known(const std::string& column) const {
  const auto named = std::find(names_.begin(), names_.end(), column);
  if (named != names_.end()) return static_cast<std::size_t>(named - names_.begin());
  bool is_number = false;
  const double number = parsed(column, false, is_number);
  if (is_number && number >= 1 && number <= static_cast<double>(columns_) && number == std::floor(number)) {
    return static_cast<std::size_t>(number) - 1;
  }
  return std::nullopt;
}

std::size_t TableReader::find(const std::string& column) const {
  if (const auto found = known(column)) return *found;
  std::string names;
  for (const std::string& name : names_) names += ", " + name;
  throw settings::InputError(path_ + ": has no column \"" + column + "\"; give 1 to " +
                             std::to_string(columns_) +
                             (names_.empty() ? " (it has no header)" : " or a name: " + names.substr(2)));
}

std::vector<std::size_t> TableReader::findAll(const std::string& columns) const {
  if (const auto one = known(columns)) return {*one};
  for (std::size_t dash = columns.find('-'); dash != std::string::npos; dash = columns.find('-', dash + 1)) {
    const auto first = known(columns.substr(0, dash)), last = known(columns.substr(dash + 1));
    if (!first || !last) continue;  // the dash may be part of a name
    if (*first > *last)
      throw settings::InputError(
          path_ + ": \"" + columns +
          "\" ends before it begins; give the column first that is first in the table");
    std::vector<std::size_t> found(*last - *first + 1);
    std::iota(found.begin(), found.end(), *first);
    return found;
  }
  return {find(columns)};
}

double TableReader::number(std::size_t column) const {
  const double value = numberOrInfinity(column);
  if (!std::isfinite(value)) throw error(column, "is " + cells_[column] + ", but must be a finite number");
  return value;
}

double TableReader::numberOrInfinity(std::size_t column) const {
  if (cells_[column].empty()) throw error(column, "is empty, but must be a number");
  bool is_number = false;
  const double value = parsed(cells_[column], format_.decimal_comma, is_number);
  if (!is_number || std::isnan(value)) {
    const bool point = format_.decimal_comma && cells_[column].find('.') != std::string::npos;
    throw error(column, "is \"" + cells_[column] + "\", but must be a number" +
                            (point ? " with a comma and without a point, because of --decimal-comma" : ""));
  }
  return value;
}

std::size_t TableReader::line() const {
  return source_->line;
}

std::string TableReader::nameOf(std::size_t column) const {
  return column < names_.size() && !names_[column].empty() ? names_[column] : std::to_string(column + 1);
}

settings::InputError TableReader::error(std::size_t column, const std::string& complaint) const {
  return settings::InputError(path_ + ", line " + std::to_string(line()) + ", column " + nameOf(column) +
                              ": " + complaint);
}

}  // namespace fsr::dataset
