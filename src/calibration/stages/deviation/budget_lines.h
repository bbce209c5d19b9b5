#pragma once

#include "calibration/stages/deviation/budget_sums.h"
#include "fsr_pressure_map/calibration/calibration.h"

namespace fsr::calibration {

/// The budget of a trained calibration, without intervals. Of the recordings only what they state is used.
ErrorBudget errorBudget(const std::vector<dataset::Recording>& recordings, const CalibrationOptions& options,
                        const BudgetScale& scale, const BudgetSums& sums, const Calibration& calibration);

}  // namespace fsr::calibration
