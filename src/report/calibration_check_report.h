#pragma once

#include <string>

#include "calibration/calibration_check.h"

namespace fsr::report {

/// The check as a table, its reasons and remarks, and the answer as the last line: "Still good." or
/// "Recalibrate, because ...".
std::string checkText(const calibration::CalibrationCheck& check);

}  // namespace fsr::report
