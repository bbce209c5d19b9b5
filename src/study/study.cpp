#include "fsr_pressure_map/study/study.h"

#include <algorithm>
#include <mutex>
#include <sstream>

#include "fsr_pressure_map/calibration/sources.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "fsr_pressure_map/statistics/random_stream.h"
#include "fsr_pressure_map/study/paper_numbers.h"
#include "fsr_pressure_map/study/study_score.h"

namespace fsr {

namespace {

// A method with its errors summed for resampling.
struct Scored {
  StudyScore score;
  CycleSums sums;
};

RepeatedMeasures measuresOf(const std::vector<const Scored*>& scored,
                            std::vector<double> StudyScore::*measure) {
  RepeatedMeasures measures;
  for (const Scored* const one : scored) {
    measures.treatments.push_back(one->score.label);
    measures.values.push_back(one->score.*measure);
  }
  return measures;
}

bool isFurther(const StudyMethod& method) {
  return paperScore(method.id) == std::nullopt;
}

// The paper's questions, one after the other, and those that it left.
class Study {
 public:
  Study(const StudyProblem& problem, const StudyProgress& progress)
      : problem_(problem),
        plan_(problem.plan),
        progress_(progress),
        data_(gatherStudyData(problem.recordings, plan_.sections)),
        methods_(paperMethods(data_, plan_.binary_share)) {
    leaveOutWhatTheKernelCannot();
  }

  StudyResult run() {
    StudyResult result = describe();
    reproduce(result);
    findBandwidths(result);
    for (const Split& split : splits()) result.splits.push_back(holdOut(split, result));
    if (plan_.beyond_the_paper) result.headline = headlineOf(result.splits.back());
    return result;
  }

 private:
  void leaveOutWhatTheKernelCannot();
  StudyResult describe() const;
  std::vector<Split> splits() const;  // easiest first
  void reproduce(StudyResult& result);
  void findBandwidths(StudyResult& result);
  SplitResult holdOut(const Split& split, StudyResult& result);
  std::vector<StudyMethod> methodsToHoldOut() const;
  // Schemes beyond the paper take the bandwidths of one model a curvature.
  std::vector<double> bandwidthsFor(const StudyMethod& method, const Examination& examination,
                                    const SplitResult& before);

  Evaluation evaluateMethod(const StudyMethod& method, const Examination& examination,
                            const std::vector<FoldModel>& models, const std::string& stage);
  Scored score(const StudyMethod& method, const Split& split, const RegressorOptions& regressor,
               const std::string& stage);
  std::vector<Scored> algorithms(const Split& split);
  StudyComparison compare(const std::string& id, const std::string& title,
                          const std::vector<const Scored*>& scored);
  StudyHeadline headlineOf(const SplitResult& split) const;
  void say(const std::string& stage, std::size_t done, std::size_t total) const {
    if (progress_) progress_(stage, done, total);
  }

  const StudyProblem& problem_;
  const StudyPlan& plan_;
  const StudyProgress& progress_;
  StudyData data_;
  std::vector<StudyMethod> methods_;
};

// The literal distance has no form with a second input.
void Study::leaveOutWhatTheKernelCannot() {
  if (plan_.grnn.distance == KernelDistance::kSquared) return;
  const auto second = [](const StudyMethod& method) { return hasSecondInput(method.plan.scheme); };
  methods_.erase(std::remove_if(methods_.begin(), methods_.end(), second), methods_.end());
  data_.warnings.push_back(
      "grnn.distance is literal: methods with a second input (2, 4, one-hot) are left out");
}

StudyResult Study::describe() const {
  const std::vector<Recording>& recordings = problem_.recordings;
  StudyResult result;
  result.plan = plan_;
  result.simulation = problem_.simulation;
  CalibrationOptions options;
  options.seed = plan_.seed;
  options.date = plan_.date;
  result.provenance = provenanceOf(recordings, options);
  result.sensor = identityOf(recordings);
  result.layout = recordings.front().layout;
  const Grouping mounts = byMount(data_);
  for (std::size_t c = 0; c < data_.classes.size(); ++c) {
    StudyClass row{data_.classes[c], data_.scans[c].size(), 0, 0};
    std::vector<bool> seen(data_.cycles, false);
    for (const StudyScan& scan : data_.scans[c]) seen[scan.cycle] = true;
    row.cycles = static_cast<std::size_t>(std::count(seen.begin(), seen.end(), true));
    for (const auto& list : mounts.scans[c]) row.mounts += !list.empty();
    result.classes.push_back(row);
  }
  result.scans = data_.scanCount();
  result.cycles = data_.cycles;
  result.mounts = data_.mounts;
  result.taxels = data_.taxels;
  result.decisions = studyDecisions(plan_, data_);
  result.unmatchable = unmatchable();
  result.holds_for = whatItHoldsFor(data_, problem_.simulation);
  result.warnings = data_.warnings;
  return result;
}

std::vector<Split> Study::splits() const {
  std::vector<Split> possible;
  for (const Split& split :
       {leaveSectionOut(data_), pastToFuture(data_), leaveCurvatureOut(data_), leaveMountOut(data_)}) {
    if (!split.folds.empty()) possible.push_back(split);
    if (!plan_.beyond_the_paper) break;
  }
  return possible;
}

Evaluation Study::evaluateMethod(const StudyMethod& method, const Examination& examination,
                                 const std::vector<FoldModel>& models, const std::string& stage) {
  std::mutex reporting;
  std::size_t done = 0;
  return evaluate(data_, method, examination, models, plan_, [&] {
    const std::lock_guard<std::mutex> lock(reporting);
    say(stage, ++done, data_.taxels.size());
  });
}

Scored Study::score(const StudyMethod& method, const Split& split, const RegressorOptions& regressor,
                    const std::string& stage) {
  const Grouping kept = downSampled(split.grouping, method.one_of, plan_.down_sampling, plan_.seed);
  const Evaluation evaluation =
      evaluateMethod(method, {kept, split.folds, Scoring::kByModel}, {plainModel(method, regressor)}, stage);
  Scored scored{scoreOf(data_, method, evaluation), CycleSums(data_, evaluation)};
  scored.score.rmse_percent_interval = rmsePercentInterval(scored.sums, data_, plan_);
  scored.score.rmse_interval = rmseInterval(scored.sums, data_, plan_);
  return scored;
}

std::vector<Scored> Study::algorithms(const Split& split) {
  const auto baseline = std::find_if(methods_.begin(), methods_.end(),
                                     [](const StudyMethod& method) { return method.id == "baseline"; });
  std::vector<Scored> scored;
  const auto add = [&](const std::string& id, const std::string& label) {
    RegressorOptions regressor{id, plan_.grnn, plan_.forest};
    regressor.forest.seed = randomStream(plan_.seed, "forest").bits(0);
    scored.push_back(score(*baseline, split, regressor, label + " on the baseline"));
    scored.back().score.id = scored.back().score.model = id;
    scored.back().score.label = label;
  };
  add("linear", "Linear regression");
  add("grnn", "GRNN");
  add("forest", "Random forest");
  return scored;
}

StudyComparison Study::compare(const std::string& id, const std::string& title,
                               const std::vector<const Scored*>& scored) {
  StudyComparison comparison{id, title, {}, {}, {}, {}};
  for (const Scored* const one : scored) comparison.scores.push_back(one->score);
  comparison.r2 = paperRule(measuresOf(scored, &StudyScore::r2), plan_.tests);
  comparison.rmse_percent = paperRule(measuresOf(scored, &StudyScore::rmse_percent), plan_.tests);
  for (std::size_t i = 0; i < scored.size(); ++i) {
    for (std::size_t j = i + 1; j < scored.size(); ++j) {
      comparison.differences.push_back({scored[i]->score.label, scored[j]->score.label,
                                        differenceInterval(scored[i]->sums, scored[j]->sums, data_, plan_)});
    }
  }
  return comparison;
}

void Study::reproduce(StudyResult& result) {
  const Split split = leaveSectionOut(data_);
  const std::vector<Scored> of_algorithms = algorithms(split);
  std::vector<Scored> scored;
  for (const StudyMethod& method : methods_) {
    scored.push_back(score(method, split, grnnOf(plan_.grnn, plan_.grnn.bandwidth), method.label));
  }
  const auto pick = [&](const std::vector<std::string>& ids) {
    std::vector<const Scored*> picked;
    for (const std::string& id : ids) {
      for (const Scored& one : scored) {
        if (one.score.id == id) picked.push_back(&one);
      }
    }
    return picked;
  };
  result.comparisons.push_back(compare("algorithms", "Algorithms on the baseline (the paper's Fig. 6)",
                                       {&of_algorithms[0], &of_algorithms[1], &of_algorithms[2]}));
  result.comparisons.push_back(compare("flat_against_all",
                                       "Flat against all curvatures (the paper's Table 2)",
                                       pick({"flat_only", "baseline"})));
  result.comparisons.push_back(
      compare("methods", "Methods (the paper's Table 3)",
              pick({"baseline", "per_curvature", "curvature_input", "flat_or_curved", "binary_input"})));
  const std::vector<const Scored*> inputs = pick({"curvature_input", "one_hot"});
  if (inputs.size() == 2) {
    result.comparisons.push_back(compare("one_hot", "Method 2 with a one-hot input", inputs));
  }
}

void Study::findBandwidths(StudyResult& result) {
  const Split split = leaveSectionOut(data_);
  for (std::size_t m = 0; m < methods_.size(); ++m) {
    say("Grid of bandwidths", m, methods_.size());
    const StudyMethod& method = methods_[m];
    if (method.plan.scheme == Scheme::kOneHot) continue;  // as curvature_input, but for widths of no use
    const Grouping kept = downSampled(split.grouping, method.one_of, plan_.down_sampling, plan_.seed);
    result.bandwidths.push_back(
        {method.id, method.label,
         bandwidthScores(data_, method, {kept, split.folds, Scoring::kByModel}, plan_)});
  }
  say("Grid of bandwidths", methods_.size(), methods_.size());
}

std::vector<double> Study::bandwidthsFor(const StudyMethod& method, const Examination& examination,
                                         const SplitResult& before) {
  for (const StudyScore& score : before.scores) {
    if (isFurther(method) && score.id == schemeName(Scheme::kPerCurvature)) return score.bandwidth;
  }
  return chooseBandwidths(data_, method, examination, plan_);
}

std::vector<StudyMethod> Study::methodsToHoldOut() const {
  std::vector<StudyMethod> methods;
  const std::vector<StudyMethod> further = furtherMethods(data_);
  for (const StudyMethod& method : methods_) {
    // The figure of predictions needs these two.
    const bool drawn = method.id == "baseline" || method.id == "per_curvature";
    if (plan_.beyond_the_paper || drawn) methods.push_back(method);
  }
  for (const StudyMethod& method : further) {
    const bool possible =
        plan_.grnn.distance == KernelDistance::kSquared || !hasSecondInput(method.plan.scheme);
    if (plan_.beyond_the_paper && possible) methods.push_back(method);
  }
  return methods;
}

SplitResult Study::holdOut(const Split& split, StudyResult& result) {
  SplitResult held_out{split.id, split.description, {}, {}};
  for (const Fold& fold : split.folds) held_out.folds.push_back(fold.name);
  const Examination examination{split.grouping, split.folds, Scoring::kPooled};
  const std::vector<StudyMethod> methods = methodsToHoldOut();
  std::vector<Evaluation> kept;
  for (const StudyMethod& method : methods) {
    const std::vector<double> bandwidth = bandwidthsFor(method, examination, held_out);
    std::vector<FoldModel> models;
    for (std::size_t k = 0; k < split.folds.size(); ++k) {
      models.push_back(learnedModel(data_, method, split.grouping, split.folds[k], bandwidth[k], plan_));
    }
    Evaluation evaluation = evaluateMethod(method, examination, models, split.id + ", " + method.label);
    StudyScore score = scoreOf(data_, method, evaluation);
    score.rmse_interval = rmseInterval(CycleSums(data_, evaluation), data_, plan_);
    score.bandwidth = bandwidth;
    held_out.scores.push_back(score);
    const bool drawn = method.id == "baseline" || method.id == "per_curvature";
    if (result.splits.empty() && drawn) kept.push_back(std::move(evaluation));
  }
  if (kept.size() == 2) {
    const std::size_t place = figureTaxel(data_, plan_, kept[1].rmse_percent);
    result.response = taxelResponse(data_, place, kept[0], kept[1]);
  }
  return held_out;
}

StudyHeadline Study::headlineOf(const SplitResult& split) const {
  const auto best = std::min_element(split.scores.begin(), split.scores.end(),
                                     [](const StudyScore& a, const StudyScore& b) {
                                       return a.errors.whole.all.rmse < b.errors.whole.all.rmse;
                                     });
  StudyHeadline headline{split.id, best->id, best->errors.whole.all.rmse, best->rmse_interval, ""};
  std::ostringstream text;
  text.precision(3);
  text << "Where " << split.description << ", the best method is " << best->id << " (" << best->label
       << ") with an RMSE of " << headline.rmse / 1e3 << " kPa";
  if (headline.interval.method != IntervalMethod::kNone) {
    text << " (95 % interval " << headline.interval.low / 1e3 << " to " << headline.interval.high / 1e3
         << " kPa over " << headline.interval.units << " " << headline.interval.level << "s)";
  }
  text << '.';
  headline.text = text.str();
  return headline;
}

}  // namespace

StudyResult study(const StudyProblem& problem, const StudyProgress& progress) {
  validate(problem.plan, "study " + problem.plan.name);
  return Study(problem, progress).run();
}

}  // namespace fsr
