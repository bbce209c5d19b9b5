#pragma once

#include <string>

#include "calibration/calibration_check.h"

namespace fsr::report {

/// A table of the check, its remarks, one line that says what the map is good for (goodForText()), and the
/// verdict in the last lines: "Still good.", "Still good as far as these bags show.", or "Recalibrate,
/// because" with the reasons.
std::string checkText(const calibration::CalibrationCheck& check);

}  // namespace fsr::report
