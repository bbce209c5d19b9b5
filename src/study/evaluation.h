#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "study/fold.h"
#include "study/paper.h"
#include "study/study.h"

namespace fsr::study {

/// How a method of several models is scored.
enum class Scoring {
  kByModel,  ///< mean of the scores of its models, as in the paper's tables
  kPooled,   ///< one score of all readings, so that methods are compared on the same readings
};

/// Held-out readings that are scored together.
struct TestPart {
  std::size_t fold = 0;
  std::size_t model = 0;            ///< 0 if readings are pooled
  std::vector<std::size_t> tested;  ///< curvature classes
};

/// The data to hold out and the way to score them.
struct Validation {
  const Grouping& grouping;  ///< the scans that the method uses, for training and for scoring
  const std::vector<Fold>& folds;
  Scoring scoring = Scoring::kByModel;
};

/// The parts, in the order of folds and models. A fold without training data for the method has no part.
std::vector<TestPart> testParts(const StudyMethod& method, const Validation& validation);

/// The parts of one fold, first to end - 1, and the classes that they test.
struct FoldParts {
  std::size_t fold = 0;
  std::size_t first = 0;
  std::size_t end = 0;
  std::vector<std::size_t> classes;

  std::size_t placeOf(std::size_t curvature_class) const;  ///< index in `classes`
};
std::vector<FoldParts> partsByFold(const std::vector<TestPart>& parts);

/// A method's held-out errors. The grouping that they were computed with must outlive it.
struct Evaluation {
  std::vector<TestPart> parts;
  /// The scored scans of each part: the lists of its cells, in the order of the errors [parts][...].
  std::vector<std::vector<const ScanList*>> scans;
  std::size_t models = 0;
  /// Predicted - reference pressure at the scored scans, ordered by part [studied taxels][scans] [Pa].
  std::vector<std::vector<float>> errors;
  /// For each studied taxel: the mean of the scores of all parts.
  std::vector<double> r2;
  std::vector<double> rmse_percent;

  /// Calls visit(part, scan, error) for the errors of data.taxels[t].
  template <typename Visit>
  void forEachError(std::size_t t, Visit visit) const {
    auto error = errors[t].begin();
    for (std::size_t p = 0; p < parts.size(); ++p) {
      for (const ScanList* const list : scans[p])
        list->forEach([&](const ScanPlace& scan) { visit(parts[p], scan, *error++); });
    }
  }
};

/// Pressure of a held-out scan of a class, at which the taxel reads `code` [Pa]. The scans of a list come in
/// their order.
using HeldOutAnswer =
    std::function<double(std::size_t curvature_class, const ScanPlace& scan, std::uint16_t code)>;
/// The answers of data.taxels[t] in one fold, trained without it.
using HeldOutAnswers =
    std::function<HeldOutAnswer(std::size_t t, const TaxelReadings& readings, const FoldParts& fold)>;

/// Scores the answers of a method. `done` is called after each taxel, from any thread.
Evaluation evaluate(const StudyData& data, const StudyMethod& method, const Validation& validation,
                    const HeldOutAnswers& answers, const StudyPlan& plan, const std::function<void()>& done);

/// Trains and scores a method. `models` has one entry for each fold, or one for all folds. `done` is called
/// after each taxel, from any thread.
Evaluation evaluate(const StudyData& data, const StudyMethod& method, const Validation& validation,
                    const std::vector<FoldModel>& models, const StudyPlan& plan,
                    const std::function<void()>& done);

/// RMSE% as by evaluate(), mean over taxels, for each of plan.bandwidths.
std::vector<double> bandwidthScores(const StudyData& data, const StudyMethod& method,
                                    const Validation& validation, const StudyPlan& plan);

/// Chooses a bandwidth for each fold by nested cross-validation within the fold's training cells: their
/// groups are held out in two halves. The bandwidth with the smallest squared error over about
/// plan.bandwidth_taxels taxels is chosen.
std::vector<double> chooseBandwidths(const StudyData& data, const StudyMethod& method,
                                     const Validation& validation, const StudyPlan& plan);

/// Summarises a method's held-out errors.
StudyScore scoreOf(const StudyData& data, const StudyMethod& method, const Evaluation& evaluation);

/// Readings and held-out predictions of one taxel, for figures. The two evaluations use all scans and five
/// sections.
TaxelResponse taxelResponse(const StudyData& data, std::size_t taxel_place, const Evaluation& baseline,
                            const Evaluation& per_curvature);

/// Index in StudyData::taxels of the taxel that the figures show.
std::size_t figureTaxel(const StudyData& data, const StudyPlan& plan,
                        const std::vector<double>& rmse_percent);

}  // namespace fsr::study
