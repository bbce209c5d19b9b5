#pragma once

#include <string>

#include "calibration/calibration_check.h"
#include "fsr_pressure_map/calibration/calibration.h"

namespace fsr::report {

/// One line without an end: what the map is good for on a new mount of a known surface (the errors that 68
/// and 95 % of the readings of left-out mounts do not exceed), the worst mount by name, and what to do next.
std::string goodForText(const calibration::Calibration& calibration);

/// The same of the bags of a check, with the worst bag.
std::string goodForText(const calibration::CalibrationCheck& check);

}  // namespace fsr::report
