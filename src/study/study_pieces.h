#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "study/evaluation.h"
#include "study/study.h"
#include "study/unit_bootstrap.h"

namespace fsr::study {

/// A method's score, with its squared errors by cycle for the intervals of differences between methods.
struct ScoredMethod {
  StudyScore score;
  CycleSums sums;
};

/// The result of a piece of a study. Pieces do not depend on each other.
struct StudyPiece {
  std::string part;                        ///< "algorithms", "methods", "bandwidths", or the id of a split
  std::vector<ScoredMethod> compared;      ///< of the paper's comparisons
  std::vector<BandwidthCurve> bandwidths;  ///< over the grid of bandwidths
  std::vector<StudyScore> held_out;        ///< of the split
  std::optional<StudyScore> with_history;  ///< likewise, with a model of the sheet's memory
  calibration::HistoryScore history;
  std::vector<CurvatureErrorCurve> curvature_errors;
  std::optional<TaxelResponse> response;
};

/// A study, or the pieces of it that one of several computers has computed.
struct StudyParts {
  /// Everything but what the pieces tell. `splits` have no scores yet.
  StudyResult frame;
  CycleUnits units;
  std::size_t pieces_of_study = 0;             ///< 0 to pieces_of_study - 1
  std::map<std::size_t, StudyPiece> computed;  ///< by number
};

/// Computes the pieces that `wanted` chooses by their number; none = all. Throws InputError.
StudyParts computeParts(const StudyProblem& problem, const std::function<bool(std::size_t)>& wanted,
                        const StudyProgress& progress);

/// The result of a study from all of its pieces: compares the methods, and names the headline.
StudyResult joinParts(const StudyParts& parts);

/// Input of all parts of a study.
struct StudyContext {
  const StudyPlan& plan;
  const StudyData& data;
  const std::vector<StudyMethod>& methods;  ///< the paper's
  const StudyProgress& progress;

  void say(const std::string& stage, std::size_t done, std::size_t total) const {
    if (progress) progress(stage, done, total);
  }
  /// Counts the taxels of a stage; can be called from any thread.
  std::function<void()> counting(const std::string& stage) const;
  /// evaluate() with progress reports.
  Evaluation evaluateMethod(const StudyMethod& method, const Validation& validation,
                            const std::vector<FoldModel>& models, const std::string& stage) const;
};

/// A piece of the study that can be computed without the others.
struct PlannedPiece {
  std::string part;  ///< as StudyPiece::part
  std::function<void(StudyPiece& result)> compute;
};

/// The scores that the paper's comparisons are made of: one piece for each algorithm and method.
std::vector<PlannedPiece> comparisonPieces(const StudyContext& study);
/// The paper's comparisons.
std::vector<StudyComparison> comparisonsOf(const StudyParts& parts);

/// RMSE% over the grid of bandwidths, for each method but one-hot: at useful bandwidths it equals
/// curvature_input.
std::vector<PlannedPiece> bandwidthPieces(const StudyContext& study);

/// The ways to hold data out that the recordings permit, easiest first.
std::vector<Split> splitsOf(const StudyContext& study);
/// All methods on all scans for each split, the choice of a model of the sheet's memory, the errors with
/// wrong curvatures, and the data for the figures of one taxel. `splits` must outlive the pieces.
std::vector<PlannedPiece> holdOutPieces(const StudyContext& study, const std::vector<Split>& splits);

/// The best method in the hardest split, where the best method has the largest error.
StudyHeadline headlineOf(const std::vector<SplitResult>& splits);

}  // namespace fsr::study
