#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "statistics/bootstrap.h"
#include "study/evaluation.h"

namespace fsr::study {

/// Squared errors of a method by cycle: enough to say how its scores change when cycles, or whole mounts,
/// are drawn anew.
class CycleSums {
 public:
  CycleSums(const StudyData& data, const Evaluation& evaluation);

  /// Those with readings, ascending.
  std::vector<std::size_t> cycles() const;

  /// RMSE% of the range of all scans: mean over taxels and models, the readings of a model pooled.
  double rmsePercent(const std::vector<std::size_t>& cycles) const;
  /// Of all readings of all taxels [Pa].
  double rmse(const std::vector<std::size_t>& cycles) const;

 private:
  std::size_t taxels_, models_, cycles_;
  double range_;
  std::vector<double> squares_;      // [cycles x models x taxels] [Pa^2]
  std::vector<double> readings_;     // [cycles x models], of each taxel
  std::vector<double> all_squares_;  // [cycles], of all taxels and models
};

// Intervals of the scores: the highest level with five units is resampled, mounts where the surfaces were
// mounted more than once each, else cycles. Cycles of all conditions are drawn together.

statistics::BootstrapResult rmsePercentInterval(const CycleSums& sums, const StudyData& data,
                                                const StudyPlan& plan);
statistics::BootstrapResult rmseInterval(const CycleSums& sums, const StudyData& data, const StudyPlan& plan);
/// Of first - second, both on the same draws.
statistics::BootstrapResult differenceInterval(const CycleSums& first, const CycleSums& second,
                                               const StudyData& data, const StudyPlan& plan);

}  // namespace fsr::study
