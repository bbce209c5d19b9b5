#pragma once

#include "compensation/scheme_plan.h"
#include "fsr_pressure_map/calibration/calibration.h"

namespace fsr::calibration {

/// Computes the rule of calibration.tables: length scale, law, and the uncertainty for a curvature that was
/// not in training. Everything else in the tables, the statistics and the regressor must be complete. Returns
/// the errors from which the uncertainty was found.
UnseenScore learnRule(const compensation::SchemePlan& plan, unsigned threads, Calibration& calibration);

}  // namespace fsr::calibration
