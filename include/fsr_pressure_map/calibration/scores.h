#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "fsr_pressure_map/dataset/condition_classes.h"
#include "fsr_pressure_map/statistics/metrics.h"

namespace fsr::calibration {

/// Errors of held-out readings: each section is predicted by models that never saw it.
struct Score {
  std::uint64_t readings = 0;  ///< scans x taxels
  /// Mean and deviation over taxels. Of each taxel: the mean of its sections' scores, the range of
  /// RMSE% being that of the held-out section.
  statistics::Spread r2;
  statistics::Spread rmse_percent;
  std::size_t worst_taxel = 0;  ///< the one of the largest RMSE%
  double worst_rmse_percent = std::numeric_limits<double>::quiet_NaN();
  /// Of all taxels and sections together [Pa].
  statistics::BinnedErrors errors;
  /// Share of the readings within one stated deviation, the deviation taken from other sections.
  double within_one_deviation = std::numeric_limits<double>::quiet_NaN();
};

/// One curvature class of the bags, predicted as the scheme would.
struct ConditionScore {
  dataset::CurvatureClass condition;
  bool trained = true;  ///< false: the answering model saw nothing of this class (flat_only on a bend)
  Score score;
};

/// Inner surfaces, each in turn answered as if training had not seen it: what a new curvature may expect.
struct UnseenScore {
  std::uint64_t readings =
      0;  ///< scans x taxels; 0 = there is no inner surface, or the scheme has no classes
  statistics::Spread rmse_percent;  ///< mean and deviation over taxels, of the range of pressure
  double rmse = std::numeric_limits<double>::quiet_NaN();  ///< of all readings together [Pa]
};

struct CalibrationScores {
  std::vector<ConditionScore> conditions;  ///< empty = not asked for
  Score whole;                             ///< all conditions together
  UnseenScore unseen;
};

}  // namespace fsr::calibration
