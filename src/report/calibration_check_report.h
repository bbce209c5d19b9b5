#pragma once

#include <string>

#include "calibration/calibration_check.h"

namespace fsr::report {

/// A table of the check, its remarks, and the verdict in the last lines: "Still good." or "Recalibrate,
/// because" with the reasons.
std::string checkText(const calibration::CalibrationCheck& check);

}  // namespace fsr::report
