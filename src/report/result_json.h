#pragma once

#include <nlohmann/json.hpp>

#include "fsr_pressure_map/calibration/calibration.h"
#include "fsr_pressure_map/statistics/metrics.h"

namespace fsr::discrepancy {
struct DiscrepancyReport;
}

namespace fsr::report {

// JSON of types that several results use. Numbers are SI; NaN is written as null.

using Json = nlohmann::ordered_json;

Json json(const statistics::Spread& spread);
Json json(const statistics::ErrorSummary& errors);
/// Errors of all readings ("whole") and of each pressure bin, for both directions.
Json json(const statistics::BinnedErrors& errors);
Json json(const dataset::SensorIdentity& sensor);
Json json(const calibration::Provenance& provenance);
/// All members of results.json of a discrepancy report. verdict.yaml has some of them.
Json discrepancyMembers(const discrepancy::DiscrepancyReport& report);

/// Indented text with one line feed at the end. Invalid UTF-8 is replaced.
std::string dump(const Json& document);

}  // namespace fsr::report
