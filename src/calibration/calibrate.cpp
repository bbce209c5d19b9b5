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
#include "settings/step_progress.h"

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

// Training of a calibration: the recordings in the form that training needs, and the work on each taxel.
class Training {
 public:
  explicit Training(const CalibrationProblem& problem)
      : problem_(problem),
        classes_(
            dataset::poolConditions(problem.recordings, compensation::poolingOf(problem.options.scheme))) {
    for (const dataset::Recording& recording : problem.recordings) {
      sections_.push_back(dataset::divideIntoSections(recording, problem.options.folds));
    }
    plan_ = compensation::planScheme(problem.options.scheme, classes_.classes);
    sessions_ = findSessions(problem.recordings, classes_);
    scans_ = gatherScans(problem.recordings, classes_, sections_, zeros_);
  }

  Calibration run(const CalibrationProgress& progress) {
    Calibration calibration = describe();
    const std::size_t taxels = statistics_->taxels;
    matrix::forEachTaxel(taxels, problem_.options.threads, [&](std::size_t taxel) { sum(taxel); });
    findTaxelsWithoutModel(plan_, problem_.recordings.front().name, calibration);

    const compensation::FoldRegressors regressors = chooseWithZeros(calibration, progress);
    RemountErrors remount(problem_.recordings, classes_, sections_, zeros_);
    const BudgetInput budget{BudgetScale(calibration.trained.pressure),
                             budgetCycles(problem_.recordings, classes_, sections_), !remount.assessable()};
    HeldOutScoring scoring(scans_, sections_, plan_, budget, problem_.options.folds, taxels);
    settings::StepProgress training(progress, "training the taxels", taxels);
    matrix::forEachTaxel(taxels, problem_.options.threads, [&](std::size_t taxel) {
      train(taxel, regressors, calibration, scoring);
      if (calibration.no_model[taxel] == 0) remount.measure(plan_, taxel, regressors.whole, calibration);
      training.partDone();
    });
    const RemountScore remounted = remount.apply(calibration);
    const UnseenScore unseen = learnRule(plan_, problem_.options.threads, calibration);
    if (problem_.options.scores) {
      const SessionScore session = calibration.scores.session;
      calibration.scores = scoring.summarise(classes_.classes);
      calibration.scores.session = session;
      calibration.scores.unseen = unseen;
      calibration.scores.remount = remounted;
      budget_scale_ = budget.scale;
      budget_sums_ = scoring.budget();
      calibration.budget.intervals =
          remount.assessable() ? intervalsOf(remount, regressors.whole, calibration) : scoring.intervals();
      if (remount.assessable()) new_mount_ = remount.newMount();
    }
    const HistoryProblem problem{problem_.recordings,
                                 classes_,
                                 sections_,
                                 plan_,
                                 regressors.whole,
                                 zeros_,
                                 calibration.session_zero.expected() ? &sessions_ : nullptr};
    const settings::StepProgress memory(progress, "history and temperature", 1);
    trainHistory(problem, problem_.options, calibration);
    calibration.temperature = chooseTemperature(problem, problem_.options, calibration);
    return calibration;
  }

  /// Gives the calibration of run(), which is complete otherwise, its error budget.
  void addBudget(Calibration& calibration) const {
    if (!problem_.options.scores) return;
    ErrorIntervals intervals = std::move(calibration.budget.intervals);
    calibration.budget = errorBudget(problem_, *budget_scale_, budget_sums_, calibration);
    calibration.budget.lines.push_back(newMountLine(calibration, new_mount_));
    calibration.budget.intervals = std::move(intervals);
  }

  /// `calibration`: of run(), with its ranges of training.
  void addShape(Calibration& calibration) const {
    trainShape(problem_.recordings, sessions_, problem_.options.threads, calibration);
  }

 private:
  // Everything except the results of each taxel.
  Calibration describe();
  std::shared_ptr<compensation::TrainingStatistics> emptyStatistics() const;
  void sum(std::size_t taxel);
  ErrorIntervals intervalsOf(RemountErrors& remount, const regression::RegressorOptions& regressor,
                             const Calibration& calibration) const;
  compensation::FoldRegressors chooseWithZeros(Calibration& calibration, const CalibrationProgress& progress);
  void train(std::size_t taxel, const compensation::FoldRegressors& regressors, Calibration& calibration,
             HeldOutScoring& scoring) const;

  const CalibrationProblem& problem_;
  dataset::ConditionClasses classes_;
  std::vector<dataset::Sections> sections_;
  compensation::SchemePlan plan_;
  Sessions sessions_;
  SessionZeros zeros_;  // empty = none
  TrainingScans scans_;
  std::shared_ptr<compensation::TrainingStatistics> statistics_;  // filled by sum()
  std::optional<BudgetScale> budget_scale_;                       // by run(), where there are scores
  BudgetSums budget_sums_;
  NewMountErrors new_mount_;
};

Calibration Training::describe() {
  const std::vector<dataset::Recording>& recordings = problem_.recordings;
  const dataset::Recording& first = recordings.front();
  const std::size_t taxels = first.layout.size.taxels();
  std::vector<bool> trained(classes_.classes.size(), false);
  Calibration calibration;
  calibration.bandwidth_chosen = choosesBandwidth(problem_.options);
  calibration.folds = problem_.options.folds;
  calibration.sensor = identityOf(recordings);
  calibration.layout = first.layout;
  calibration.masked = unionOfMasks(recordings, taxels);
  for (const compensation::SchemePlan::Model& model : plan_.models) {
    for (const std::size_t curvature_class : model.trained_on) trained[curvature_class] = true;
  }
  calibration.trained = findTrainedRanges(recordings, classes_, trained);
  calibration.coverage = dataset::measureCoverage(recordings, classes_, sections_);
  calibration.provenance = provenanceOf(problem_.recordings, problem_.options);
  statistics_ = emptyStatistics();
  calibration.statistics = statistics_;
  prepareTables(plan_, calibration);
  calibration.warnings = warningsOf(recordings, sections_);
  return calibration;
}

std::shared_ptr<compensation::TrainingStatistics> Training::emptyStatistics() const {
  auto statistics = std::make_shared<compensation::TrainingStatistics>();
  statistics->full_scale = problem_.recordings.front().full_scale;
  statistics->taxels = problem_.recordings.front().layout.size.taxels();
  statistics->sections = problem_.options.folds;
  statistics->classes = classes_.classes;
  statistics->cells.resize(statistics->taxels * classes_.classes.size() * problem_.options.folds);
  for (const dataset::Recording& recording : problem_.recordings) {
    const std::vector<dataset::RecordedCondition> own = dataset::conditionsOf(recording);
    statistics->conditions.insert(statistics->conditions.end(), own.begin(), own.end());
  }
  return statistics;
}

void Training::sum(std::size_t taxel) {
  std::vector<regression::CodeStatistics> cells =
      statisticsOfTaxel(scans_, statistics_->sections, statistics_->full_scale, taxel);
  std::move(cells.begin(), cells.end(),
            statistics_->cells.begin() + static_cast<std::ptrdiff_t>(taxel * cells.size()));
}

// The choice of zeros needs a regressor. If there are zeros, the regressor is chosen again with them.
compensation::FoldRegressors Training::chooseWithZeros(Calibration& calibration,
                                                       const CalibrationProgress& progress) {
  const compensation::FoldRegressors regressors = choose(problem_.options, calibration, plan_, progress);
  zeros_ = chooseSessionZero({problem_.recordings, classes_, sections_, plan_, regressors.whole, zeros_},
                             sessions_, problem_.options, calibration);
  if (zeros_.empty()) return regressors;
  scans_ = gatherScans(problem_.recordings, classes_, sections_, zeros_);
  matrix::forEachTaxel(statistics_->taxels, problem_.options.threads, [&](std::size_t taxel) { sum(taxel); });
  plan_ = compensation::planScheme(problem_.options.scheme, classes_.classes);
  return choose(problem_.options, calibration, plan_, progress);
}

void Training::train(std::size_t taxel, const compensation::FoldRegressors& regressors,
                     Calibration& calibration, HeldOutScoring& scoring) const {
  if (calibration.no_model[taxel] != 0) {
    fillTables(plan_, taxel, {}, calibration);
    scoring.leaveOut(taxel);
    return;
  }
  compensation::SectionedReadings readings = readingsOf(*calibration.statistics, taxel);
  if (!regression::makeRegressor(regressors.whole)->mergeable()) {
    readings.samples = samplesOfTaxel(scans_, readings.sums.front().size(), readings.full_scale, taxel);
  }
  const bool scores = problem_.options.scores;
  const auto models = compensation::crossValidateScheme(
      plan_, taxel, readings, regressors,
      scores ? regression::HeldOutDeviation::kYes : regression::HeldOutDeviation::kNo);
  if (scores) scoring.scoreTaxel(taxel, models);
  fillTables(plan_, taxel, models, calibration);
}

// The intervals of new mounts. The models without a mount are trained a second time, because the deviation to
// compare with is known only after the first.
ErrorIntervals Training::intervalsOf(RemountErrors& remount, const regression::RegressorOptions& regressor,
                                     const Calibration& calibration) const {
  IntervalTally intervals(IntervalUnit::kMounts, remount.units(), statistics_->taxels,
                          calibration.trained.pressure.high);
  matrix::forEachTaxel(statistics_->taxels, problem_.options.threads, [&](std::size_t taxel) {
    if (calibration.no_model[taxel] == 0) remount.cover(plan_, taxel, regressor, calibration, intervals);
  });
  return intervals.summarise();
}

// Trains everything again for the temperature T_0 of the model that was chosen.
Calibration trainAtReference(const CalibrationProblem& problem, const Calibration& chosen,
                             const CalibrationProgress& progress) {
  CalibrationProblem at_reference{atReference(problem.recordings, chosen.temperature), problem.options};
  at_reference.options.temperature = false;
  Training training(at_reference);
  Calibration calibration = training.run(progress);
  training.addShape(calibration);
  calibration.temperature = chosen.temperature;
  calibration.scores.temperature = chosen.scores.temperature;
  calibration.trained = chosen.trained;  // of the recorded pressures
  training.addBudget(calibration);
  return calibration;
}

}  // namespace

void TrainedInterval::include(double value) {
  if (std::isnan(value)) return;
  if (!(low <= value)) low = value;
  if (!(high >= value)) high = value;
}

Calibration calibrate(const CalibrationProblem& problem, const CalibrationProgress& progress) {
  validate(problem);
  Training training(problem);
  Calibration calibration = training.run(progress);
  if (calibration.temperature.present()) return trainAtReference(problem, calibration, progress);
  training.addShape(calibration);
  training.addBudget(calibration);
  return calibration;
}

}  // namespace fsr::calibration
