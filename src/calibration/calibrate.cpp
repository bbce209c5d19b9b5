#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include "calibration/sources.h"
#include "calibration/stages/deviation/budget_lines.h"
#include "calibration/stages/deviation/held_out_scoring.h"
#include "calibration/stages/deviation/interval_tally.h"
#include "calibration/stages/deviation/new_mount_line.h"
#include "calibration/stages/deviation/remount_errors.h"
#include "calibration/stages/memory/history_training.h"
#include "calibration/stages/session/session_rests.h"
#include "calibration/stages/session/session_zero.h"
#include "calibration/stages/shape/learn_from_mounts.h"
#include "calibration/stages/tables/taxel_training.h"
#include "calibration/stages/tables/training_scans.h"
#include "calibration/stages/temperature/temperature_course.h"
#include "calibration/stages/temperature/temperature_training.h"
#include "compensation/fit_scheme.h"
#include "compensation/training_statistics.h"
#include "dataset/sections.h"
#include "fsr_pressure_map/calibration/calibration.h"
#include "fsr_pressure_map/dataset/condition_classes.h"
#include "fsr_pressure_map/dataset/recording.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "matrix/for_each_taxel.h"
#include "settings/progress.h"

namespace fsr::calibration {

namespace {

// Over a shorter time, noise would count as a rate; over a longer one, a gap would hide it [s].
constexpr double kRateSpan = 1.0;
constexpr double kLongestRateSpan = 2.0;

// The rate of the pressure from scan `i` over kRateSpan. `later` moves along with i. NaN if the condition
// changes or the scans pause in between.
double rateFrom(const dataset::Recording& recording, std::size_t i, std::size_t& later) {
  while (later < recording.scans() && recording.time[later] - recording.time[i] < kRateSpan) ++later;
  if (later == recording.scans() || recording.condition[later] != recording.condition[i]) return NAN;
  const double span = recording.time[later] - recording.time[i];
  if (span > kLongestRateSpan) return NAN;
  return (recording.pressure[later] - recording.pressure[i]) / span;
}

// The ranges over the scans of those classes for which `trained` is true.
TrainedRanges findTrainedRanges(const std::vector<dataset::Recording>& recordings,
                                const dataset::ConditionClasses& classes, const std::vector<bool>& trained) {
  TrainedRanges ranges;
  for (std::size_t r = 0; r < recordings.size(); ++r) {
    const dataset::Recording& recording = recordings[r];
    std::size_t later = 0;
    for (std::size_t i = 0; i < recording.scans(); ++i) {
      if (!trained[classes.class_of[r][recording.condition[i]]]) continue;
      ranges.pressure.include(recording.pressure[i]);
      ranges.pressure_rate.include(rateFrom(recording, i, later));
      if (!recording.temperature.empty()) ranges.temperature.include(recording.temperature[i]);
    }
  }
  for (std::size_t c = 0; c < classes.classes.size(); ++c) {
    if (!trained[c]) continue;
    for (const double curvature : classes.classes[c].curvature) ranges.curvature.include(curvature);
  }
  return ranges;
}

// A training of a calibration: what its stages share, and the calibration as far as it is.
class Training {
 public:
  Training(const CalibrationProblem& problem, const CalibrationProgress& progress)
      : options_(problem.options), progress_(progress), recordings_(&problem.recordings) {}

  Calibration run();

 private:
  using Stage = void (Training::*)();

  // Each stage is fitted on what those before it leave.
  void begin();
  void temperature();
  void sessionZero();
  void tables();
  void remount();
  void curvatureRule();
  void scores();
  void memory();
  void shape();
  void budget();
  static constexpr Stage kStages[] = {&Training::begin,  &Training::temperature, &Training::sessionZero,
                                      &Training::tables, &Training::remount,     &Training::curvatureRule,
                                      &Training::scores, &Training::memory,      &Training::shape,
                                      &Training::budget};

  Calibration describe();
  std::shared_ptr<compensation::TrainingStatistics> emptyStatistics() const;
  void sumReadings();
  void sum(std::size_t taxel);
  void train(std::size_t taxel);
  ErrorIntervals intervalsOfMounts();
  HistoryProblem history() const;
  template <typename Work>
  void forEachTaxel(Work&& work) const {
    matrix::forEachTaxel(statistics_->taxels, options_.threads, work);
  }

  CalibrationOptions options_;
  const CalibrationProgress& progress_;
  const std::vector<dataset::Recording>* recordings_;
  std::vector<dataset::Recording> at_reference_;  // their pressures as they were at T_0; empty = as recorded

  dataset::ConditionClasses classes_;
  std::vector<dataset::Sections> sections_;
  compensation::SchemePlan plan_;
  Sessions sessions_;
  SessionZeros zeros_;  // empty = none
  TrainingScans scans_;
  compensation::FoldRegressors regressors_;
  std::shared_ptr<compensation::TrainingStatistics> statistics_;  // filled by sumReadings()
  std::optional<RemountErrors> remount_;
  std::optional<HeldOutScoring> scoring_;
  RemountScore remounted_;
  UnseenScore unseen_;
  std::optional<BudgetScale> budget_scale_;
  Calibration calibration_;
};

Calibration Training::run() {
  for (const Stage stage : kStages) (this->*stage)();
  return std::move(calibration_);
}

// The recordings in the form that training needs, and a calibration without tables.
void Training::begin() {
  classes_ = dataset::poolConditions(*recordings_, compensation::poolingOf(options_.scheme));
  for (const dataset::Recording& recording : *recordings_)
    sections_.push_back(dataset::divideIntoSections(recording, options_.folds));
  plan_ = compensation::planScheme(options_.scheme, classes_.classes);
  calibration_ = describe();
  sumReadings();
  findTaxelsWithoutModel(plan_, recordings_->front().name, calibration_);
}

// If the readings depend on the temperature, the pressures that follow are those at T_0.
void Training::temperature() {
  const TemperatureModel model =
      chooseTemperature({*recordings_, classes_, sections_}, options_, calibration_);
  if (!model.present()) return;
  calibration_.temperature = model;
  at_reference_ = atReference(*recordings_, model);
  recordings_ = &at_reference_;
  sumReadings();
}

// The choice of zeros needs a regressor. If there are zeros, the regressor is chosen again with them.
void Training::sessionZero() {
  sessions_ = findSessions(*recordings_, classes_);
  referToTraining(*recordings_, plan_, sessions_);
  regressors_ = choose(options_, calibration_, plan_, progress_);
  zeros_ = chooseSessionZero({*recordings_, classes_, sections_, plan_, regressors_.whole, zeros_}, sessions_,
                             options_, calibration_);
  if (zeros_.empty()) return;
  sumReadings();
  plan_ = compensation::planScheme(options_.scheme, classes_.classes);
  regressors_ = choose(options_, calibration_, plan_, progress_);
}

void Training::tables() {
  remount_.emplace(*recordings_, classes_, sections_, zeros_);
  const BudgetInput budget{BudgetScale(calibration_.trained.pressure),
                           budgetCycles(*recordings_, classes_, sections_), !remount_->assessable()};
  budget_scale_ = budget.scale;
  scoring_.emplace(scans_, sections_, plan_, budget, options_.folds, statistics_->taxels);
  settings::StepProgress training(progress_, "training the taxels", statistics_->taxels);
  forEachTaxel([&](std::size_t taxel) {
    train(taxel);
    if (calibration_.no_model[taxel] == 0) remount_->measure(plan_, taxel, regressors_.whole, calibration_);
    training.partDone();
  });
  rememberRests(sessions_, calibration_);
}

// The deviation grows by the error on another mount.
void Training::remount() {
  remounted_ = remount_->apply(calibration_);
}

void Training::curvatureRule() {
  unseen_ = learnRule(plan_, options_.threads, calibration_);
}

void Training::scores() {
  if (!options_.scores) return;
  CalibrationScores scores = scoring_->summarise(classes_.classes);
  scores.session = std::move(calibration_.scores.session);
  scores.temperature = std::move(calibration_.scores.temperature);
  calibration_.scores = std::move(scores);
  calibration_.scores.unseen = unseen_;
  calibration_.scores.remount = remounted_;
  calibration_.budget.intervals = remount_->assessable() ? intervalsOfMounts() : scoring_->intervals();
}

HistoryProblem Training::history() const {
  return {*recordings_,
          classes_,
          sections_,
          plan_,
          regressors_.whole,
          zeros_,
          calibration_.session_zero.expected() ? &sessions_ : nullptr};
}

void Training::memory() {
  const settings::StepProgress memory(progress_, "history", 1);
  trainHistory(history(), options_, calibration_);
}

void Training::shape() {
  trainShape(*recordings_, sessions_, options_.threads, calibration_);
}

void Training::budget() {
  if (!options_.scores) return;
  ErrorIntervals intervals = std::move(calibration_.budget.intervals);
  calibration_.budget = errorBudget(*recordings_, options_, *budget_scale_, scoring_->budget(), calibration_);
  calibration_.budget.lines.push_back(
      newMountLine(calibration_, remount_->assessable() ? remount_->newMount() : NewMountErrors()));
  calibration_.budget.intervals = std::move(intervals);
}

Calibration Training::describe() {
  const std::vector<dataset::Recording>& recordings = *recordings_;
  const dataset::Recording& first = recordings.front();
  const std::size_t taxels = first.layout.size.taxels();
  std::vector<bool> trained(classes_.classes.size(), false);
  Calibration calibration;
  calibration.bandwidth_chosen = choosesBandwidth(options_);
  calibration.folds = options_.folds;
  calibration.sensor = identityOf(recordings);
  calibration.layout = first.layout;
  calibration.masked = unionOfMasks(recordings, taxels);
  for (const compensation::SchemePlan::Model& model : plan_.models) {
    for (const std::size_t curvature_class : model.trained_on) trained[curvature_class] = true;
  }
  calibration.trained = findTrainedRanges(recordings, classes_, trained);
  calibration.coverage = dataset::measureCoverage(recordings, classes_, sections_);
  calibration.provenance = provenanceOf(*recordings_, options_);
  statistics_ = emptyStatistics();
  calibration.statistics = statistics_;
  prepareTables(plan_, calibration);
  calibration.warnings = warningsOf(recordings, sections_);
  return calibration;
}

std::shared_ptr<compensation::TrainingStatistics> Training::emptyStatistics() const {
  auto statistics = std::make_shared<compensation::TrainingStatistics>();
  statistics->full_scale = recordings_->front().full_scale;
  statistics->taxels = recordings_->front().layout.size.taxels();
  statistics->sections = options_.folds;
  statistics->classes = classes_.classes;
  statistics->cells.resize(statistics->taxels * classes_.classes.size() * options_.folds);
  for (const dataset::Recording& recording : *recordings_) {
    const std::vector<dataset::RecordedCondition> own = dataset::conditionsOf(recording);
    statistics->conditions.insert(statistics->conditions.end(), own.begin(), own.end());
  }
  return statistics;
}

void Training::sumReadings() {
  scans_ = gatherScans(*recordings_, classes_, sections_, zeros_);
  forEachTaxel([&](std::size_t taxel) { sum(taxel); });
}

void Training::sum(std::size_t taxel) {
  std::vector<regression::CodeStatistics> cells =
      statisticsOfTaxel(scans_, statistics_->sections, statistics_->full_scale, taxel);
  std::move(cells.begin(), cells.end(),
            statistics_->cells.begin() + static_cast<std::ptrdiff_t>(taxel * cells.size()));
}

void Training::train(std::size_t taxel) {
  if (calibration_.no_model[taxel] != 0) {
    fillTables(plan_, taxel, {}, calibration_);
    scoring_->leaveOut(taxel);
    return;
  }
  compensation::SectionedReadings readings = readingsOf(*calibration_.statistics, taxel);
  if (!regression::makeRegressor(regressors_.whole)->mergeable()) {
    readings.samples = samplesOfTaxel(scans_, readings.sums.front().size(), readings.full_scale, taxel);
  }
  const auto models = compensation::crossValidateScheme(
      plan_, taxel, readings, regressors_,
      options_.scores ? regression::HeldOutDeviation::kYes : regression::HeldOutDeviation::kNo);
  if (options_.scores) scoring_->scoreTaxel(taxel, models);
  fillTables(plan_, taxel, models, calibration_);
}

// The intervals of new mounts. The models without a mount are trained a second time, because the deviation to
// compare with is known only after the first.
ErrorIntervals Training::intervalsOfMounts() {
  IntervalTally intervals(IntervalUnit::kMounts, remount_->units(), statistics_->taxels,
                          calibration_.trained.pressure.high);
  forEachTaxel([&](std::size_t taxel) {
    if (calibration_.no_model[taxel] == 0)
      remount_->cover(plan_, taxel, regressors_.whole, calibration_, intervals);
  });
  return intervals.summarise();
}

}  // namespace

void TrainedInterval::include(double value) {
  if (std::isnan(value)) return;
  if (!(low <= value)) low = value;
  if (!(high >= value)) high = value;
}

Calibration calibrate(const CalibrationProblem& problem, const CalibrationProgress& progress) {
  validate(problem);
  return Training(problem, progress).run();
}

}  // namespace fsr::calibration
