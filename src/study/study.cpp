#include "study/study.h"

#include <algorithm>
#include <memory>
#include <mutex>

#include "calibration/sources.h"
#include "calibration/stages/memory/history_training.h"
#include "study/study_context.h"

namespace fsr::study {

namespace {

// Removes methods with a second input if the kernel uses the literal distance, which is defined for one input
// only.
void leaveOutSecondInputs(const StudyPlan& plan, std::vector<StudyMethod>& methods, StudyData& data) {
  if (plan.grnn.distance == regression::KernelDistance::kSquared) return;
  const auto second = [](const StudyMethod& method) {
    return compensation::hasSecondInput(method.plan.scheme);
  };
  methods.erase(std::remove_if(methods.begin(), methods.end(), second), methods.end());
  data.warnings.push_back(
      "grnn.distance is literal: methods with a second input (2, 4, one-hot) are left out");
}

StudyResult describe(const StudyProblem& problem, const StudyData& data, const std::vector<Split>& splits) {
  const std::vector<dataset::Recording>& recordings = problem.recordings;
  StudyResult result;
  result.plan = problem.plan;
  result.simulation = problem.simulation;
  calibration::CalibrationOptions options;
  options.seed = problem.plan.seed;
  options.date = problem.plan.date;
  result.provenance = calibration::provenanceOf(recordings, options);
  result.sensor = calibration::identityOf(recordings);
  result.layout = recordings.front().layout;
  const Grouping mounts = byMount(data);
  for (std::size_t c = 0; c < data.classes.size(); ++c) {
    StudyClass row{data.classes[c], data.scans[c].size(), 0, 0};
    std::vector<bool> seen(data.cycles, false);
    data.scans[c].forEach([&](const ScanPlace& scan) { seen[data.cycle(scan)] = true; });
    row.cycles = static_cast<std::size_t>(std::count(seen.begin(), seen.end(), true));
    for (const auto& list : mounts.scans[c]) row.mounts += !list.empty();
    result.classes.push_back(row);
  }
  result.scans = data.scanCount();
  result.cycles = data.cycles;
  result.mounts = data.mounts;
  result.taxels = data.taxels;
  result.decisions = studyDecisions(problem.plan, data);
  if (fittedToThePaper(problem.simulation)) result.unmatchable = unmatchable();
  result.holds_for = limitations(data, problem.simulation);
  result.warnings = data.warnings;
  for (const Split& split : splits) {
    result.splits.push_back({split.id, split.description, {}, {}});
    for (const Fold& fold : split.folds) result.splits.back().folds.push_back(fold.name);
  }
  // Stays if no split chooses a model.
  if (problem.plan.beyond_the_paper) {
    result.history.choice =
        "not assessable: " + calibration::whyNoProtocolIsLeftOut(data.protocols.names.size()) + ".";
  }
  return result;
}

}  // namespace

std::function<void()> StudyContext::counting(const std::string& stage) const {
  struct Count {
    std::mutex reporting;
    std::size_t done = 0;
  };
  return [this, stage, count = std::make_shared<Count>()] {
    const std::lock_guard<std::mutex> lock(count->reporting);
    say(stage, ++count->done, data.taxels.size());
  };
}

Evaluation StudyContext::evaluateMethod(const StudyMethod& method, const Validation& validation,
                                        const std::vector<FoldModel>& models,
                                        const std::string& stage) const {
  return evaluate(data, method, validation, models, plan, counting(stage));
}

StudyResult study(const StudyProblem& problem, const StudyProgress& progress) {
  validate(problem.plan, "study " + problem.plan.name);
  StudyData data = gatherStudyData(problem.recordings, problem.plan.sections);
  std::vector<StudyMethod> methods = paperMethods(data, problem.plan.binary_share);
  leaveOutSecondInputs(problem.plan, methods, data);
  const StudyContext context{problem.plan, data, methods, progress};
  const std::vector<Split> splits = splitsOf(context);
  StudyResult result = describe(problem, data, splits);
  result.comparisons = comparisonsOf(context);
  result.bandwidths = bandwidthCurves(context);
  holdOut(context, splits, result);
  if (problem.plan.beyond_the_paper) result.headline = headlineOf(result.splits);
  return result;
}

}  // namespace fsr::study
