#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "fsr_pressure_map/regression/regressors.h"
#include "fsr_pressure_map/study/fold.h"
#include "fsr_pressure_map/study/study_method.h"

namespace fsr {

/// Which regressor a method's models are, for each fold (one = the same for all).
using SplitRegressors = std::vector<RegressorOptions>;
SplitRegressors kernels(const std::vector<double>& bandwidth, const GrnnOptions& options);

/// Held-out readings of one model in one fold.
struct TestPart {
  std::size_t fold = 0;
  std::size_t model = 0;            ///< that answers
  std::vector<std::size_t> tested;  ///< classes
  std::vector<std::size_t> asked;   ///< what the model is asked for in their place: the nearest it knows
};

/// What a method's models are asked, and by which of them each reading is answered. A class that no model
/// has trained on goes to the model of the nearest trained one.
std::vector<TestPart> testParts(const StudyData& data, const StudyMethod& method, const Grouping& grouping,
                                const std::vector<Fold>& folds);

/// A method's held-out errors.
struct Evaluation {
  std::vector<TestPart> parts;
  /// The scans that were scored, part after part, and where each part begins; one more than parts.
  std::vector<const StudyScan*> scans;
  std::vector<std::size_t> begin;
  /// Predicted - reference [Pa] of each of `scans`, for each taxel that takes part.
  std::vector<std::vector<float>> errors;
  /// Of each taxel that takes part: the mean of the scores of all parts.
  std::vector<double> r2;
  std::vector<double> rmse_percent;
};

/// `grouping` says which scans a method uses, in training and in scoring alike. `done` is called after each
/// taxel, from any thread.
Evaluation evaluate(const StudyData& data, const StudyMethod& method, const Grouping& grouping,
                    const std::vector<Fold>& folds, const SplitRegressors& regressors, const StudyPlan& plan,
                    const std::function<void()>& done);

/// For each fold the bandwidth of least held-out squared error within the fold's training cells, group by
/// group, over about plan.bandwidth_taxels taxels together: nested cross-validation.
std::vector<double> chooseBandwidths(const StudyData& data, const StudyMethod& method,
                                     const Grouping& grouping, const std::vector<Fold>& folds,
                                     const StudyPlan& plan);

/// RMSE% as evaluate() would give it, mean over taxels, for each of plan.bandwidths.
std::vector<double> bandwidthScores(const StudyData& data, const StudyMethod& method,
                                    const Grouping& grouping, const std::vector<Fold>& folds,
                                    const StudyPlan& plan);

}  // namespace fsr
