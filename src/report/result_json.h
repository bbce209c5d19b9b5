#pragma once

#include <nlohmann/json.hpp>

#include "fsr_pressure_map/calibration/calibration.h"
#include "fsr_pressure_map/statistics/metrics.h"

namespace fsr::report {

// What several results have in common, as JSON. Numbers are SI; NaN is written as null.

using Json = nlohmann::ordered_json;

Json json(const statistics::Spread& spread);
Json json(const statistics::ErrorSummary& errors);
/// "whole" and each pressure bin, in both directions.
Json json(const statistics::BinnedErrors& errors);
Json json(const dataset::SensorIdentity& sensor);
Json json(const calibration::Provenance& provenance);

/// Indented, one line feed at the end; text that is no UTF-8 is mended.
std::string dump(const Json& document);

}  // namespace fsr::report
