#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "study/evaluation.h"
#include "study/study.h"

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

/// The paper's comparisons of algorithms and methods.
std::vector<StudyComparison> comparisonsOf(const StudyContext& study);

/// RMSE% over the grid of bandwidths, for each method but one-hot: at useful bandwidths it equals
/// curvature_input.
std::vector<BandwidthCurve> bandwidthCurves(const StudyContext& study);

/// The ways to hold data out that the recordings permit, easiest first.
std::vector<Split> splitsOf(const StudyContext& study);
/// Adds the scores of all methods on all scans to each of `result.splits`, which are those of `splits`; in
/// the first split also the errors with wrong curvatures and the data for the figures of one taxel; where
/// protocols are held out, the choice of a model of the sheet's memory.
void holdOut(const StudyContext& study, const std::vector<Split>& splits, StudyResult& result);

/// The best method in the hardest split, where the best method has the largest error.
StudyHeadline headlineOf(const std::vector<SplitResult>& splits);

}  // namespace fsr::study
