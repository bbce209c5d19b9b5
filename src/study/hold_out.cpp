#include "study/hold_out.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <sstream>

#include "matrix/for_each_taxel.h"
#include "study/evaluation.h"
#include "study/paper.h"
#include "study/study_context.h"
#include "study/unit_bootstrap.h"

namespace fsr::study {

namespace {

constexpr char kPerCurvature[] = "per_curvature";

bool isFurther(const StudyMethod& method) {
  return paperScore(method.id) == std::nullopt;
}

// Whether the figure of predictions shows the method.
bool isDrawn(const StudyMethod& method) {
  return method.id == "baseline" || method.id == kPerCurvature;
}

bool bent(const StudyData& data) {
  return !std::all_of(data.classes.begin(), data.classes.end(), dataset::isFlat);
}

std::vector<StudyMethod> methodsOf(const StudyContext& study) {
  std::vector<StudyMethod> methods;
  const std::vector<StudyMethod> further = furtherMethods(study.data);
  for (const StudyMethod& method : study.methods) {
    if (study.plan.beyond_the_paper || isDrawn(method)) methods.push_back(method);
  }
  for (const StudyMethod& method : further) {
    const bool possible = study.plan.grnn.distance == regression::KernelDistance::kSquared ||
                          !compensation::hasSecondInput(method.plan.scheme);
    if (study.plan.beyond_the_paper && possible) methods.push_back(method);
  }
  return methods;
}

// One split: its methods and what they share.
class HeldOutMethods {
 public:
  HeldOutMethods(const StudyContext& study, const Split& split, bool first, StudyResult& result)
      : study_(study), split_(split), first_(first), result_(result) {}

  std::vector<StudyScore> scores();

 private:
  Validation validation() const { return {split_.grouping, split_.folds, Scoring::kPooled}; }
  std::vector<double> bandwidthsFor(const StudyMethod& method);
  std::vector<FoldModel> modelsOf(const StudyMethod& method, const std::vector<double>& bandwidth) const;
  Evaluation evaluate(const StudyMethod& method);
  void addHistory(const StudyMethod& method, const std::vector<FoldModel>& models,
                  const std::vector<double>& bandwidth);

  const StudyContext& study_;
  const Split& split_;
  const bool first_;  // of the splits
  StudyResult& result_;
  std::vector<StudyScore> scores_;
  std::optional<StudyScore> with_history_;
  std::vector<double> of_per_curvature_;  // bandwidths
};

// Schemes beyond the paper, which come last, use the bandwidths that are chosen for per_curvature.
std::vector<double> HeldOutMethods::bandwidthsFor(const StudyMethod& method) {
  if (isFurther(method)) return of_per_curvature_;
  const std::vector<double> chosen = chooseBandwidths(study_.data, method, validation(), study_.plan);
  if (method.id == kPerCurvature) of_per_curvature_ = chosen;
  return chosen;
}

std::vector<FoldModel> HeldOutMethods::modelsOf(const StudyMethod& method,
                                                const std::vector<double>& bandwidth) const {
  std::vector<FoldModel> models;
  for (std::size_t k = 0; k < split_.folds.size(); ++k) {
    models.push_back(
        learnedModel(study_.data, method, split_.grouping, split_.folds[k], bandwidth[k], study_.plan));
  }
  return models;
}

// Adds the static answer of per_curvature with a model of the sheet's memory; nothing if no reading counts.
void HeldOutMethods::addHistory(const StudyMethod& method, const std::vector<FoldModel>& models,
                                const std::vector<double>& bandwidth) {
  const std::string stage = split_.id + ", history";
  study_.say(stage, 0, study_.data.taxels.size());
  const HistoryStudy history(study_.data, split_, models, study_.plan);
  if (history.verdict().score.protocols.empty()) return;
  result_.history = history.verdict().score;
  const Evaluation evaluation = history.evaluate(method, study_.counting(stage));
  StudyScore score = scoreOf(study_.data, method, evaluation);
  score.id = "history";
  score.label = "History";
  score.rmse_interval = rmseInterval(CycleSums(study_.data, evaluation), study_.data, study_.plan);
  score.bandwidth = bandwidth;
  with_history_ = score;
}

Evaluation HeldOutMethods::evaluate(const StudyMethod& method) {
  const std::string stage = split_.id + ", " + method.id;
  study_.say(stage, 0, study_.data.taxels.size());
  const std::vector<double> bandwidth = bandwidthsFor(method);
  const std::vector<FoldModel> models = modelsOf(method, bandwidth);
  Evaluation evaluation = study_.evaluateMethod(method, validation(), models, stage);
  StudyScore score = scoreOf(study_.data, method, evaluation);
  score.rmse_interval = rmseInterval(CycleSums(study_.data, evaluation), study_.data, study_.plan);
  score.bandwidth = bandwidth;
  scores_.push_back(score);
  if (first_ && study_.plan.beyond_the_paper && bent(study_.data))
    result_.curvature_errors.push_back(curvatureErrorsOf(study_, method, validation(), models));
  if (split_.id == kProtocolSplit && method.id == kPerCurvature) addHistory(method, models, bandwidth);
  return evaluation;
}

std::vector<StudyScore> HeldOutMethods::scores() {
  std::vector<Evaluation> drawn;
  for (const StudyMethod& method : methodsOf(study_)) {
    Evaluation evaluation = evaluate(method);
    if (!first_ || !isDrawn(method)) continue;
    drawn.push_back(std::move(evaluation));
    if (drawn.size() < 2) continue;
    const std::size_t place = figureTaxel(study_.data, study_.plan, drawn[1].rmse_percent);
    result_.response = taxelResponse(study_.data, place, drawn[0], drawn[1]);
    drawn.clear();
  }
  if (with_history_) scores_.push_back(*with_history_);
  return scores_;
}

double rmse(const StudyScore& score) {
  return score.errors.whole.all.rmse;
}

const StudyScore& best(const SplitResult& split) {
  return *std::min_element(split.scores.begin(), split.scores.end(),
                           [](const StudyScore& a, const StudyScore& b) { return rmse(a) < rmse(b); });
}

}  // namespace

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

void holdOut(const StudyContext& study, const std::vector<Split>& splits, StudyResult& result) {
  for (std::size_t s = 0; s < splits.size(); ++s)
    result.splits[s].scores = HeldOutMethods(study, splits[s], s == 0, result).scores();
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

namespace {

using calibration::HistoryStream;
using calibration::HistorySums;
using calibration::LeftOutSums;
using calibration::StaticAnswer;

// Sets the codes of training; returns whether there are any.
bool setTrainedCodes(const regression::CodeHistogram& readings, StaticAnswer& answer) {
  const auto& count = readings.count();
  const auto occurs = [](std::int64_t number) { return number > 0; };
  const auto first = std::find_if(count.begin(), count.end(), occurs);
  if (first == count.end()) return false;
  const auto last = std::find_if(count.rbegin(), count.rend(), occurs);
  answer.lowest = static_cast<std::uint16_t>(first - count.begin());
  answer.highest = static_cast<std::uint16_t>(count.rend() - last - 1);
  return true;
}

}  // namespace

HistoryStudy::HistoryStudy(const StudyData& data, const Split& split, const std::vector<FoldModel>& models,
                           const StudyPlan& plan)
    : data_(data),
      split_(split),
      models_(models),
      plan_(plan),
      grid_(calibration::historyGrid(data.protocols.lowest, data.protocols.highest,
                                     data.protocols.longest_hold)),
      streams_(
          calibration::historyStreams(*data.recordings, data.class_of, data.divided, data.protocols, grid_)) {
  std::vector<std::vector<LeftOutSums>> each(data.taxels.size());
  matrix::forEachTaxel(each.size(), plan.threads, [&](std::size_t t) { each[t] = sumsOf(data.taxels[t]); });
  // Taxels are added in their order, so that the result does not depend on the number of threads.
  std::vector<std::string> names;
  std::vector<LeftOutSums> all;
  for (std::size_t k = 0; k < split.folds.size(); ++k) {
    names.push_back(split.folds[k].name);
    all.emplace_back(grid_.features());
    for (const std::vector<LeftOutSums>& own : each) all.back().merge(own[k]);
    all.back().finish();
  }
  verdict_ = calibration::chooseHistory({}, grid_, names, all);
}

std::vector<StaticAnswer> HistoryStudy::staticAnswers(std::size_t taxel, std::size_t fold,
                                                      const TaxelReadings& readings) const {
  const regression::ClassReadings training = readings.training(split_.folds[fold].train, false);
  std::vector<StaticAnswer> answers(data_.classes.size());
  std::vector<std::size_t> trained;
  for (std::size_t c = 0; c < answers.size(); ++c)
    if (setTrainedCodes(training.sums[c], answers[c])) trained.push_back(c);
  auto tables = tablesFor(models_[fold], taxel, training, trained);
  for (std::size_t i = 0; i < trained.size(); ++i) answers[trained[i]].pressure = std::move(tables[i]);
  calibration::setTrainedPressures(streams_, protocolOf(split_.folds[fold]), answers);
  return answers;
}

std::vector<LeftOutSums> HistoryStudy::sumsOf(std::size_t taxel) const {
  const TaxelReadings readings(data_, split_.grouping, taxel);
  std::vector<LeftOutSums> of_fold;
  for (std::size_t k = 0; k < split_.folds.size(); ++k) {
    const std::vector<StaticAnswer> answers = staticAnswers(taxel, k, readings);
    LeftOutSums sums(grid_.features());
    calibration::HistoryCourse course;
    for (const HistoryStream& stream : streams_)
      calibration::addHistoryRows(
          stream, grid_, taxel, answers, calibration::HistoryRows::kReadings, course,
          [&](const auto& scan) -> HistorySums& { return sums.of(scan, protocolOf(split_.folds[k])); });
    sums.finish();
    of_fold.push_back(std::move(sums));
  }
  return of_fold;
}

HeldOutAnswer HistoryStudy::answer(std::size_t taxel, std::size_t fold, const TaxelReadings& readings) const {
  const std::vector<StaticAnswer> tables = staticAnswers(taxel, fold, readings);
  const Eigen::VectorXd& coefficients = verdict_.coefficients[fold];
  Eigen::VectorXd features(Eigen::Index(grid_.features()));
  // Of the scans of each recording [Pa]; NaN = the static answer stands.
  const auto corrected = std::make_shared<std::vector<std::vector<double>>>(streams_.size());
  calibration::HistoryCourse course;
  for (const HistoryStream& stream : streams_) {
    std::vector<double>& own = (*corrected)[stream.number()];
    own.assign(stream.recording().scans(), std::numeric_limits<double>::quiet_NaN());
    stream.run(taxel, tables, course,
               [&](const HistoryStream::Scan& scan, double x, const double* state, const double* /*open*/) {
                 if (scan.protocol != protocolOf(split_.folds[fold])) return;
                 calibration::historyFeatures(grid_, x, state, features.data());
                 own[scan.number] = x + coefficients.dot(features);
               });
  }
  return [tables, corrected](std::size_t c, const ScanPlace& scan, std::uint16_t code) {
    const double pressure = (*corrected)[scan.recording][scan.number];
    return std::isnan(pressure) ? tables[c].pressure[code] : pressure;
  };
}

Evaluation HistoryStudy::evaluate(const StudyMethod& method, const std::function<void()>& done) const {
  const auto answers = [&](std::size_t t, const TaxelReadings& readings, const FoldParts& fold) {
    return answer(data_.taxels[t], fold.fold, readings);
  };
  return study::evaluate(data_, method, {split_.grouping, split_.folds, Scoring::kPooled},
                         HeldOutAnswers(answers), plan_, done);
}

}  // namespace fsr::study
