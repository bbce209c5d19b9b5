#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "fsr_pressure_map/settings/input_error.h"
#include "fsr_pressure_map/settings/range.h"

namespace fsr::settings {

/// One mapping of a YAML file, read strictly. A key that is missing, of a wrong type, out of range or
/// unknown throws an InputError that names the file, the field (dotted path), the value and what would be
/// right.
///
/// Every read marks its key as known. refuseUnknown(), called after the last read, refuses all other keys,
/// so that a misspelt optional key is never silently ignored.
class Settings {
 public:
  static Settings fromFile(const std::string& path);
  /// `origin`: name that messages give instead of a file.
  static Settings fromText(const std::string& yaml, const std::string& origin);

  bool has(const std::string& key) const;
  bool isList(const std::string& key) const;

  double number(const std::string& key, const Range& range) const;
  double number(const std::string& key, const Range& range, double fallback) const;
  std::int64_t integer(const std::string& key, const Range& range) const;
  std::int64_t integer(const std::string& key, const Range& range, std::int64_t fallback) const;
  bool flag(const std::string& key, bool fallback) const;
  std::string text(const std::string& key) const;
  std::string text(const std::string& key, const std::string& fallback) const;
  /// One of `choices`.
  std::string choice(const std::string& key, const std::vector<std::string>& choices) const;
  std::string choice(const std::string& key, const std::vector<std::string>& choices,
                     const std::string& fallback) const;
  /// A list of numbers, each within `range`.
  std::vector<double> numbers(const std::string& key, const Range& range) const;
  /// A list of texts.
  std::vector<std::string> texts(const std::string& key) const;
  /// A list of lists of texts.
  std::vector<std::vector<std::string>> lists(const std::string& key) const;
  /// A number, or NaN where the key is null.
  double numberOrNull(const std::string& key, const Range& range) const;
  /// A nested mapping.
  Settings section(const std::string& key) const;
  /// A list of mappings.
  std::vector<Settings> sections(const std::string& key) const;
  /// The keys of this mapping, in the order of the file. This call marks none of them as known.
  std::vector<std::string> keys() const;

  /// Throws InputError where a key was never read, in this mapping or in a section that was opened.
  void refuseUnknown() const;

  /// An InputError about `key` of this mapping: "FILE: FIELD is VALUE, but " + `complaint`.
  [[nodiscard]] InputError error(const std::string& key, const std::string& complaint) const;

  const std::string& origin() const;

 private:
  struct Node;
  explicit Settings(std::shared_ptr<Node> node);
  std::shared_ptr<Node> node_;
};

}  // namespace fsr::settings
