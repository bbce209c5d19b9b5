#pragma once

#include <array>
#include <vector>

#include "calibration/correction/correction_fit.h"

namespace fsr::calibration {

/// Which model of a change predicts cycles that it was not fitted to best, and what that is worth.
struct CorrectionChoice {
  ChangeModel model = ChangeModel::kNone;  ///< the smallest error on cycles that were left out, all together
  /// RMSE of each model on cycles that were left out, all together [Pa].
  std::array<double, kChangeModels> rmse = {};
  double expected = 0;  ///< RMSE that the parent's stated deviations let expect of the same readings [Pa]
  /// RMSE of the choice itself: each cycle is predicted by the model that was chosen without it [Pa].
  double nested = 0;
  /// Probability of such a gain over ChangeModel::kNone if there is none: one-sided paired t test of the
  /// logarithms of the cycles' mean squared errors, parent against choice.
  double p = 1;
  std::vector<ReadingChange> changes;  ///< [taxels], of `model`, fitted to all cycles
};

/// Leaves each cycle out once. The choice is nested: within the cycles that are left, each is left out again.
/// Models that are richer than `richest` are not chosen; their RMSE is given all the same.
CorrectionChoice chooseCorrection(const CorrectionFit& fit, ChangeModel richest = ChangeModel::kTaxels);

}  // namespace fsr::calibration
