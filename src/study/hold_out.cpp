#include <algorithm>
#include <optional>
#include <sstream>

#include "study/curvature_error.h"
#include "study/history_study.h"
#include "study/paper_numbers.h"
#include "study/study_context.h"
#include "study/study_score.h"

namespace fsr::study {

namespace {

bool isFurther(const StudyMethod& method) {
  return paperScore(method.id) == std::nullopt;
}

bool bent(const StudyData& data) {
  return !std::all_of(data.classes.begin(), data.classes.end(), dataset::isFlat);
}

std::vector<Split> splitsOf(const StudyContext& study) {
  std::vector<Split> possible;
  for (const Split& split :
       {leaveSectionOut(study.data), pastToFuture(study.data), leaveProtocolOut(study.data),
        leaveCurvatureOut(study.data), leaveMountOut(study.data)}) {
    if (!split.folds.empty()) possible.push_back(split);
    if (!study.plan.beyond_the_paper) break;
  }
  return possible;
}

std::vector<StudyMethod> methodsOf(const StudyContext& study) {
  std::vector<StudyMethod> methods;
  const std::vector<StudyMethod> further = furtherMethods(study.data);
  for (const StudyMethod& method : study.methods) {
    // The figure of predictions shows these two methods.
    const bool drawn = method.id == "baseline" || method.id == "per_curvature";
    if (study.plan.beyond_the_paper || drawn) methods.push_back(method);
  }
  for (const StudyMethod& method : further) {
    const bool possible = study.plan.grnn.distance == regression::KernelDistance::kSquared ||
                          !compensation::hasSecondInput(method.plan.scheme);
    if (study.plan.beyond_the_paper && possible) methods.push_back(method);
  }
  return methods;
}

// Schemes beyond the paper use the bandwidths that were chosen for per_curvature.
std::vector<double> bandwidthsFor(const StudyContext& study, const StudyMethod& method,
                                  const Validation& validation, const SplitResult& before) {
  for (const StudyScore& score : before.scores) {
    if (isFurther(method) && score.id == compensation::schemeName(compensation::Scheme::kPerCurvature))
      return score.bandwidth;
  }
  return chooseBandwidths(study.data, method, validation, study.plan);
}

// The static answer of per_curvature with a model of the sheet's memory. None if no reading counts.
std::optional<StudyScore> withHistory(const StudyContext& study, const StudyMethod& method,
                                      const Split& split, const std::vector<FoldModel>& models,
                                      HeldOut& result) {
  const std::string stage = split.id + ", history";
  study.say(stage, 0, study.data.taxels.size());
  const HistoryStudy history(study.data, split, models, study.plan);
  if (history.verdict().score.protocols.empty()) return std::nullopt;
  result.history = history.verdict().score;
  const Evaluation evaluation = history.evaluate(method, study.counting(stage));
  StudyScore score = scoreOf(study.data, method, evaluation);
  score.id = "history";
  score.label = "History";
  score.rmse_interval = rmseInterval(CycleSums(study.data, evaluation), study.data, study.plan);
  return score;
}

SplitResult holdOutOne(const StudyContext& study, const Split& split, HeldOut& result) {
  SplitResult held_out{split.id, split.description, {}, {}};
  for (const Fold& fold : split.folds) held_out.folds.push_back(fold.name);
  const Validation validation{split.grouping, split.folds, Scoring::kPooled};
  const std::vector<StudyMethod> methods = methodsOf(study);
  std::vector<Evaluation> kept;
  std::optional<StudyScore> history;
  for (const StudyMethod& method : methods) {
    const std::string stage = split.id + ", " + method.id;
    study.say(stage, 0, study.data.taxels.size());
    const std::vector<double> bandwidth = bandwidthsFor(study, method, validation, held_out);
    std::vector<FoldModel> models;
    for (std::size_t k = 0; k < split.folds.size(); ++k) {
      models.push_back(
          learnedModel(study.data, method, split.grouping, split.folds[k], bandwidth[k], study.plan));
    }
    Evaluation evaluation = study.evaluateMethod(method, validation, models, stage);
    StudyScore score = scoreOf(study.data, method, evaluation);
    score.rmse_interval = rmseInterval(CycleSums(study.data, evaluation), study.data, study.plan);
    score.bandwidth = bandwidth;
    held_out.scores.push_back(score);
    const bool drawn = method.id == "baseline" || method.id == "per_curvature";
    if (result.splits.empty() && drawn) kept.push_back(std::move(evaluation));
    if (result.splits.empty() && study.plan.beyond_the_paper && bent(study.data))
      result.curvature_errors.push_back(curvatureErrorsOf(study, method, validation, models));
    if (split.id != kProtocolSplit || method.id != "per_curvature") continue;
    history = withHistory(study, method, split, models, result);
    if (history) history->bandwidth = bandwidth;
  }
  if (history) held_out.scores.push_back(*history);
  if (kept.size() == 2) {
    const std::size_t place = figureTaxel(study.data, study.plan, kept[1].rmse_percent);
    result.response = taxelResponse(study.data, place, kept[0], kept[1]);
  }
  return held_out;
}

double rmse(const StudyScore& score) {
  return score.errors.whole.all.rmse;
}

const StudyScore& best(const SplitResult& split) {
  return *std::min_element(split.scores.begin(), split.scores.end(),
                           [](const StudyScore& a, const StudyScore& b) { return rmse(a) < rmse(b); });
}

}  // namespace

HeldOut holdOut(const StudyContext& study) {
  HeldOut result;
  for (const Split& split : splitsOf(study)) result.splits.push_back(holdOutOne(study, split, result));
  if (study.plan.beyond_the_paper && result.history.protocols.empty()) {
    result.history.choice =
        "not assessable: " + calibration::whyNoProtocolIsLeftOut(study.data.protocols.names.size()) + ".";
  }
  return result;
}

StudyHeadline headlineOf(const std::vector<SplitResult>& splits) {
  const auto harder = [](const SplitResult& a, const SplitResult& b) {
    return rmse(best(a)) < rmse(best(b));
  };
  const SplitResult& split = *std::max_element(splits.begin(), splits.end(), harder);
  const StudyScore& score = best(split);
  StudyHeadline headline{split.id, score.id, rmse(score), score.rmse_interval, ""};
  std::ostringstream text;
  text.precision(3);
  text << "Hardest of " << splits.size() << " splits: " << split.description << ". Best of "
       << split.scores.size() << " methods there: " << score.id << ", RMSE " << headline.rmse / 1e3 << " kPa";
  if (headline.interval.method != statistics::IntervalMethod::kNone) {
    text << " (95 % interval " << headline.interval.low / 1e3 << " to " << headline.interval.high / 1e3
         << " kPa over " << headline.interval.units << " " << headline.interval.level << "s)";
  }
  text << ".";
  headline.text = text.str();
  return headline;
}

}  // namespace fsr::study
