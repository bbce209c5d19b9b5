#pragma once

#include <string>

#include "calibration/correction/recheck.h"
#include "fsr_pressure_map/calibration/calibration.h"

namespace fsr::report {

/// A recheck for the terminal: errors of each model on cycles that were left out, gain and offset, the
/// verdict and its reasons.
std::string recheckText(const calibration::Recheck& recheck);

/// The same as indented JSON, numbers in SI and counts. `child`: id of the file that was written; empty =
/// none.
std::string recheckJson(const calibration::Recheck& recheck, const std::string& parent,
                        const std::string& child);

}  // namespace fsr::report
