#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "fsr_pressure_map/dataset/condition_classes.h"
#include "fsr_pressure_map/statistics/metrics.h"

namespace fsr::calibration {

/// Errors of held-out readings: each section is predicted by models that were trained without it.
struct Score {
  std::uint64_t readings = 0;  ///< scans x taxels
  /// Mean and standard deviation over taxels. The value of a taxel is the mean over its sections; the range
  /// for RMSE% is that of the held-out section.
  statistics::Spread r2;
  statistics::Spread rmse_percent;
  std::size_t worst_taxel = 0;  ///< the taxel with the largest RMSE%
  double worst_rmse_percent = std::numeric_limits<double>::quiet_NaN();
  /// Errors of all taxels and sections together [Pa].
  statistics::BinnedErrors errors;
  /// Share of the readings within one stated deviation; the deviation comes from other sections.
  double within_one_deviation = std::numeric_limits<double>::quiet_NaN();
};

/// One curvature class of the bags, predicted by the scheme.
struct ConditionScore {
  dataset::CurvatureClass condition;
  bool trained =
      true;  ///< false: the model that answers was not trained on this class (flat_only on a bent surface)
  Score score;
};

/// Errors on inner surfaces, each in turn predicted as if it were not in the training: the error to expect on
/// a new curvature.
struct UnseenScore {
  std::uint64_t readings =
      0;  ///< scans x taxels; 0 = there is no inner surface, or the scheme has no classes
  statistics::Spread rmse_percent;  ///< mean and standard deviation over taxels, % of the range of pressure
  double rmse = std::numeric_limits<double>::quiet_NaN();  ///< of all readings together [Pa]
};

struct CalibrationScores {
  std::vector<ConditionScore> conditions;  ///< empty = not computed
  Score whole;                             ///< all conditions together
  UnseenScore unseen;
};

}  // namespace fsr::calibration
