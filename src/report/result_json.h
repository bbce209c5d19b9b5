#pragma once

#include <nlohmann/json.hpp>
#include <string>

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

}  // namespace fsr::report
