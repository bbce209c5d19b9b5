#pragma once

#include <cstddef>
#include <string>

#include "fsr_pressure_map/calibration/calibration.h"

namespace fsr::report {

/// What `train` prints of a training on one screen, at most kSummaryLines lines.
std::string trainingSummary(const calibration::Calibration& calibration);
constexpr std::size_t kSummaryLines = 25;

/// One line without an end: what the map is good for on a new mount of a known surface (the errors that 68
/// and 95 % of the readings of left-out mounts do not exceed), the worst mount by name, and what to do next.
std::string goodForText(const calibration::Calibration& calibration);

/// All tables of a training but its coverage.
std::string trainingDetails(const calibration::Calibration& calibration);

}  // namespace fsr::report
