#pragma once

#include <vector>

#include "calibration/stages/deviation/budget_sums.h"
#include "dataset/conditioning.h"
#include "fsr_pressure_map/calibration/calibration.h"
#include "fsr_pressure_map/calibration/error_budget.h"

namespace fsr::calibration {

/// The line of the conditioning: how much the answer changes from the first cycle of a mount to the later
/// ones, and whether the sheet was conditioned before. `sessions` as findConditioning() tells.
BudgetLine conditioningLine(const BudgetSums& sums, const std::vector<dataset::Conditioning>& sessions);

/// Says in the line of the conditioning what `sessions` tell, which may know more than the recordings did.
void restateConditioning(const std::vector<dataset::Conditioning>& sessions, ErrorBudget& budget);

/// The budget of a trained calibration, without intervals. Of the recordings only what they state is used.
ErrorBudget errorBudget(const std::vector<dataset::Recording>& recordings, const CalibrationOptions& options,
                        const BudgetScale& scale, const BudgetSums& sums, const Calibration& calibration);

}  // namespace fsr::calibration
