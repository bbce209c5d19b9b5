#pragma once

#include <functional>
#include <string>
#include <vector>

#include "study/evaluation.h"
#include "study/study.h"
#include "study/study_pieces.h"

namespace fsr::study {

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
