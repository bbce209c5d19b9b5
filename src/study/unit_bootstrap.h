#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "statistics/bootstrap.h"
#include "study/evaluation.h"

namespace fsr::study {

/// Squared errors of a method by cycle. From them the scores of any resampled set of cycles or mounts are
/// computed.
class CycleSums {
 public:
  CycleSums(const StudyData& data, const Evaluation& evaluation);

  /// The cycles with readings, ascending.
  std::vector<std::size_t> cycles() const;

  /// RMSE in per cent of the range of all scans: mean over taxels and models; the readings of a model are
  /// pooled.
  double rmsePercent(const std::vector<std::size_t>& cycles) const;
  /// RMSE of all readings of all taxels [Pa].
  double rmse(const std::vector<std::size_t>& cycles) const;

 private:
  std::size_t taxels_, models_, cycles_;
  double range_;                     // of the pressure of all scans [Pa]
  std::vector<double> squares_;      // [cycles x models x taxels] [Pa^2]
  std::vector<double> readings_;     // [cycles x models], number for each taxel
  std::vector<double> all_squares_;  // [cycles], summed over taxels and models [Pa^2]
};

// Bootstrap intervals of the scores. The highest level with at least five units is resampled: mounts, if each
// surface was mounted more than once, else cycles. Cycles of all conditions are drawn together.

statistics::BootstrapResult rmsePercentInterval(const CycleSums& sums, const StudyData& data,
                                                const StudyPlan& plan);
statistics::BootstrapResult rmseInterval(const CycleSums& sums, const StudyData& data, const StudyPlan& plan);
/// The same from squared errors [Pa^2] and numbers of readings, each summed by cycle [data.cycles].
statistics::BootstrapResult rmseInterval(const std::vector<double>& squares,
                                         const std::vector<double>& readings, const StudyData& data,
                                         const StudyPlan& plan);
/// Interval of first - second, both computed from the same draws.
statistics::BootstrapResult differenceInterval(const CycleSums& first, const CycleSums& second,
                                               const StudyData& data, const StudyPlan& plan);

}  // namespace fsr::study
