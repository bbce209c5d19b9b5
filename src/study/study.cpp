#include "study/study.h"

#include <algorithm>
#include <memory>
#include <mutex>

#include "calibration/sources.h"
#include "calibration/stages/memory/history_training.h"
#include "study/study_pieces.h"

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
  // Stays if no piece has chosen a model.
  if (problem.plan.beyond_the_paper) {
    result.history.choice =
        "not assessable: " + calibration::whyNoProtocolIsLeftOut(data.protocols.names.size()) + ".";
  }
  return result;
}

std::vector<PlannedPiece> piecesOf(const StudyContext& study, const std::vector<Split>& splits) {
  std::vector<PlannedPiece> pieces;
  for (const std::vector<PlannedPiece>& some :
       {comparisonPieces(study), bandwidthPieces(study), holdOutPieces(study, splits)})
    pieces.insert(pieces.end(), some.begin(), some.end());
  return pieces;
}

SplitResult& splitNamed(const std::string& id, StudyResult& result) {
  return *std::find_if(result.splits.begin(), result.splits.end(),
                       [&](const SplitResult& split) { return split.id == id; });
}

template <typename T>
void append(const std::vector<T>& some, std::vector<T>& all) {
  all.insert(all.end(), some.begin(), some.end());
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

StudyParts computeParts(const StudyProblem& problem, const std::function<bool(std::size_t)>& wanted,
                        const StudyProgress& progress) {
  validate(problem.plan, "study " + problem.plan.name);
  StudyData data = gatherStudyData(problem.recordings, problem.plan.sections);
  std::vector<StudyMethod> methods = paperMethods(data, problem.plan.binary_share);
  leaveOutSecondInputs(problem.plan, methods, data);
  const StudyContext context{problem.plan, data, methods, progress};
  const std::vector<Split> splits = splitsOf(context);
  StudyParts parts;
  parts.frame = describe(problem, data, splits);
  parts.units = cycleUnits(data);
  const std::vector<PlannedPiece> pieces = piecesOf(context, splits);
  parts.pieces_of_study = pieces.size();
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    if (wanted && !wanted(i)) continue;
    StudyPiece& piece = parts.computed[i];
    piece.part = pieces[i].part;
    pieces[i].compute(piece);
  }
  return parts;
}

StudyResult joinParts(const StudyParts& parts) {
  StudyResult result = parts.frame;
  result.comparisons = comparisonsOf(parts);
  for (const auto& [number, piece] : parts.computed) {
    append(piece.bandwidths, result.bandwidths);
    append(piece.curvature_errors, result.curvature_errors);
    if (!piece.held_out.empty()) append(piece.held_out, splitNamed(piece.part, result).scores);
    if (piece.response) result.response = *piece.response;
  }
  // The last score of its split.
  for (const auto& [number, piece] : parts.computed) {
    if (!piece.with_history) continue;
    splitNamed(piece.part, result).scores.push_back(*piece.with_history);
    result.history = piece.history;
  }
  if (result.plan.beyond_the_paper) result.headline = headlineOf(result.splits);
  return result;
}

StudyResult study(const StudyProblem& problem, const StudyProgress& progress) {
  return joinParts(computeParts(problem, {}, progress));
}

}  // namespace fsr::study
