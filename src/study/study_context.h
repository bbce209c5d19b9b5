#pragma once

#include <string>
#include <vector>

#include "study/evaluation.h"
#include "study/study.h"

namespace fsr::study {

/// What all parts of a study work on.
struct StudyContext {
  const StudyPlan& plan;
  const StudyData& data;
  const std::vector<StudyMethod>& methods;  ///< the paper's
  const StudyProgress& progress;

  void say(const std::string& stage, std::size_t done, std::size_t total) const {
    if (progress) progress(stage, done, total);
  }
  /// evaluate(), telling the progress.
  Evaluation evaluateMethod(const StudyMethod& method, const Examination& examination,
                            const std::vector<FoldModel>& models, const std::string& stage) const;
};

/// The paper's questions.
std::vector<StudyComparison> reproduce(const StudyContext& study);

/// One-hot is left out: it is as curvature_input, but for widths of no use.
std::vector<BandwidthCurve> gridOfBandwidths(const StudyContext& study);

/// The methods on all scans, split by split, easiest first, and what the figures show of one taxel.
struct HeldOut {
  std::vector<SplitResult> splits;
  TaxelResponse response;
};
HeldOut holdOut(const StudyContext& study);

/// Of the hardest split: the one where the best method errs most.
StudyHeadline headlineOf(const std::vector<SplitResult>& splits);

}  // namespace fsr::study
