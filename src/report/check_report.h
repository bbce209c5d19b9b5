#pragma once

#include <string>

#include "check/check.h"

namespace fsr::report {

/// A check for the terminal: errors of the map by surface, how the sheet rests, what a correction is worth,
/// remarks, one line that says what the map is good for, and the verdict with its reasons in the last lines:
/// "Still good.", "Still good as far as these bags show.", "Corrected: ...", "Cannot tell: ...",
/// "Tare: ...", "Recalibrate, because ...".
std::string checkText(const check::CheckResult& result, const calibration::Calibration& calibration);

/// Files that a check writes; empty = not wanted.
struct CheckOutputs {
  std::string calibration;  ///< of a corrected calibration
  std::string report;       ///< verdict and figures as JSON, numbers in SI and counts
};

/// Throws InputError where an output would replace a file of another kind.
void requireCheckOutputs(const CheckOutputs& outputs);

/// Writes the outputs and says where. `parent`: id of the calibration.
std::string writeCheck(const check::CheckResult& result, const std::string& parent,
                       const CheckOutputs& outputs);

}  // namespace fsr::report
