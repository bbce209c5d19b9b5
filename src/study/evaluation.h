#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "study/fold.h"
#include "study/fold_model.h"
#include "study/study_method.h"

namespace fsr::study {

/// How the readings of a method's several models are scored.
enum class Scoring {
  kByModel,  ///< the mean of the models' scores: the paper's tables
  kPooled,   ///< all readings together: methods are compared on the same readings
};

/// Held-out readings that are scored together.
struct TestPart {
  std::size_t fold = 0;
  std::size_t model = 0;            ///< 0 where they are pooled
  std::vector<std::size_t> tested;  ///< classes
};

/// What to hold out and how to score it.
struct Examination {
  const Grouping& grouping;  ///< which scans a method uses, in training and in scoring alike
  const std::vector<Fold>& folds;
  Scoring scoring = Scoring::kByModel;
};

/// In the order of folds and models. A fold that leaves a method nothing to train on has no part.
std::vector<TestPart> testParts(const StudyMethod& method, const Examination& examination);

/// Parts of one fold: first .. end - 1, and the classes that they ask about.
struct FoldParts {
  std::size_t fold = 0;
  std::size_t first = 0;
  std::size_t end = 0;
  std::vector<std::size_t> asked;

  std::size_t placeOf(std::size_t curvature_class) const;  ///< in `asked`
};
std::vector<FoldParts> partsByFold(const std::vector<TestPart>& parts);

/// A method's held-out errors.
struct Evaluation {
  std::vector<TestPart> parts;
  /// The scans that were scored, part after part, and where each part begins; one more than parts.
  std::vector<const StudyScan*> scans;
  std::vector<std::size_t> begin;
  std::size_t models = 0;
  /// Predicted - reference [Pa] of each of `scans`, for each taxel that takes part.
  std::vector<std::vector<float>> errors;
  /// Of each taxel that takes part: the mean of the scores of all parts.
  std::vector<double> r2;
  std::vector<double> rmse_percent;
};

/// `models` has one for each fold, or one for all. `done` is called after each taxel, from any thread.
Evaluation evaluate(const StudyData& data, const StudyMethod& method, const Examination& examination,
                    const std::vector<FoldModel>& models, const StudyPlan& plan,
                    const std::function<void()>& done);

/// RMSE% as evaluate() would give it, mean over taxels, for each of plan.bandwidths.
std::vector<double> bandwidthScores(const StudyData& data, const StudyMethod& method,
                                    const Examination& examination, const StudyPlan& plan);

/// For each fold the bandwidth of least held-out squared error within the fold's training cells, over about
/// plan.bandwidth_taxels taxels together: nested cross-validation, the groups of the training cells held out
/// in two halves.
std::vector<double> chooseBandwidths(const StudyData& data, const StudyMethod& method,
                                     const Examination& examination, const StudyPlan& plan);

}  // namespace fsr::study
