#pragma once

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace fsr::discrepancy {
struct DiscrepancyReport;
}

namespace fsr::report {

// JSON of results. Numbers are SI; NaN is written as null.

using Json = nlohmann::ordered_json;

/// All members of results.json of a discrepancy report. verdict.yaml has some of them.
Json discrepancyMembers(const discrepancy::DiscrepancyReport& report);

/// Indented text with one line feed at the end. Invalid UTF-8 is replaced.
inline std::string dump(const Json& document) {
  return document.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

// YAML of members that are given as JSON: a mapping with one line for each key and for each mapping of a
// list, in flow style below. What is no finite number is null.

/// All digits of a number; .inf and .nan are kept.
constexpr int kAllDigits = 0;

std::string yamlText(const Json& members, int digits);

/// A number as in yamlText().
std::string yamlNumber(double value, int digits);

/// The members with these keys, of a mapping or of each mapping of a list. "key=name" gives it another name.
Json pick(const Json& from, const std::vector<std::string>& keys);

/// The value, or `otherwise` where it is an empty text or list.
Json orElse(const Json& value, const Json& otherwise);

}  // namespace fsr::report
