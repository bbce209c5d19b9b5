#pragma once

#include <string>

#include "fsr_pressure_map/calibration/calibration_check.h"

namespace fsr {

/// The check as a table, its reasons and remarks, and the answer as the last line: "Still good." or
/// "Recalibrate, because ...".
std::string checkText(const CalibrationCheck& check);

}  // namespace fsr
