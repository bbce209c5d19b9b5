#pragma once

#include <string>
#include <vector>

#include "study/study.h"

namespace fsr::report {

/// Tables for the terminal: error of the map against error of the curvature, and how much of the change a
/// stated deviation of curvature accounts for. "" if there are no curves.
std::string curvatureErrorText(const std::vector<study::CurvatureErrorCurve>& curves);

}  // namespace fsr::report
