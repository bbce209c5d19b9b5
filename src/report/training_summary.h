#pragma once

#include <cstddef>
#include <string>

#include "fsr_pressure_map/calibration/calibration.h"

namespace fsr::report {

/// What `train` prints of a training on one screen, at most kSummaryLines lines.
std::string trainingSummary(const calibration::Calibration& calibration);
constexpr std::size_t kSummaryLines = 25;

/// All tables of a training but its coverage.
std::string trainingDetails(const calibration::Calibration& calibration);

}  // namespace fsr::report
