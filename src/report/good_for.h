#pragma once

#include <string>

#include "fsr_pressure_map/calibration/calibration.h"

namespace fsr::report {

/// One line without an end: what the map is good for on a new mount of a known surface (the errors that 68
/// and 95 % of the readings of left-out mounts do not exceed), the worst mount by name, and what to do next.
std::string goodForText(const calibration::Calibration& calibration);

}  // namespace fsr::report
