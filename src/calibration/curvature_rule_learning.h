#pragma once

#include "compensation/scheme_plan.h"
#include "fsr_pressure_map/calibration/calibration.h"

namespace fsr::calibration {

/// Fills in the rule of calibration.tables, which is otherwise complete, as are statistics and regressor:
/// length scale, law, and what a curvature that training has not seen is uncertain by. Returns the errors
/// behind the last.
UnseenScore learnRule(const compensation::SchemePlan& plan, unsigned threads, Calibration& calibration);

}  // namespace fsr::calibration
