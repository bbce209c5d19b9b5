#include <algorithm>
#include <mutex>

#include "fsr_pressure_map/calibration/bandwidth_choice.h"
#include "fsr_pressure_map/calibration/calibration.h"
#include "fsr_pressure_map/calibration/held_out_scoring.h"
#include "fsr_pressure_map/calibration/sources.h"
#include "fsr_pressure_map/calibration/training_scans.h"
#include "fsr_pressure_map/compensation/fit_scheme.h"
#include "fsr_pressure_map/matrix/for_each_taxel.h"
#include "fsr_pressure_map/settings/input_error.h"

namespace fsr {

namespace {

// A reading that never changes tells nothing.
bool varies(const TrainingStatistics& statistics, const SchemePlan::Model& model, std::size_t taxel) {
  TrainedInterval codes;
  for (const std::size_t curvature_class : model.trained_on) {
    for (std::size_t section = 0; section < statistics.sections; ++section) {
      const CodeStatistics& cell = statistics.cell(taxel, curvature_class, section);
      if (cell.empty()) continue;
      codes.include(cell.code().front());
      codes.include(cell.code().back());
    }
  }
  return codes.low < codes.high;
}

CodeTable noModel(std::uint16_t full_scale) {
  CodeTable table;
  table.pressure.assign(full_scale + 1u, std::numeric_limits<float>::quiet_NaN());
  table.deviation = table.support = table.pressure;
  return table;
}

SectionedReadings readingsOf(const TrainingStatistics& statistics, std::size_t taxel) {
  SectionedReadings readings;
  readings.full_scale = statistics.full_scale;
  for (std::size_t k = 0; k < statistics.classes.size(); ++k) {
    const CodeStatistics* const first = &statistics.cell(taxel, k, 0);
    readings.sums.emplace_back(first, first + statistics.sections);
  }
  return readings;
}

// The recordings as training sees them, and what becomes of them taxel by taxel.
class Training {
 public:
  explicit Training(const CalibrationProblem& problem)
      : problem_(problem), classes_(poolConditions(problem.recordings)) {
    for (const Recording& recording : problem.recordings) {
      sections_.push_back(divideIntoSections(recording, problem.options.folds));
    }
    plan_ = planScheme(problem.options.scheme, classes_.classes);
    scans_ = gatherScans(problem.recordings, classes_, sections_);
  }

  Calibration run(const CalibrationProgress& progress) {
    Calibration calibration = describe();
    const std::size_t taxels = calibration.statistics.taxels;
    forEachTaxel(taxels, problem_.options.threads, [&](std::size_t taxel) { sum(taxel, calibration); });
    warnOfConstantTaxels(calibration);

    const FoldRegressors regressors =
        chooseRegressor(problem_.options, plan_, calibration.statistics, calibration.no_model);
    calibration.regressor = regressors.whole;
    HeldOutScoring scoring(scans_, plan_, problem_.options.folds, taxels);
    std::mutex reporting;
    std::size_t done = 0;
    forEachTaxel(taxels, problem_.options.threads, [&](std::size_t taxel) {
      train(taxel, regressors, calibration, scoring);
      const std::lock_guard<std::mutex> lock(reporting);
      if (progress) progress(++done, taxels);
    });
    if (problem_.options.scores) calibration.scores = scoring.summarise(classes_.classes);
    return calibration;
  }

 private:
  // Everything but what is found taxel by taxel.
  Calibration describe() const;
  // The statistics of a taxel, and whether they carry a model.
  void sum(std::size_t taxel, Calibration& calibration) const;
  void train(std::size_t taxel, const FoldRegressors& regressors, Calibration& calibration,
             HeldOutScoring& scoring) const;
  void warnOfConstantTaxels(Calibration& calibration) const;

  const CalibrationProblem& problem_;
  ConditionClasses classes_;
  std::vector<Sections> sections_;
  SchemePlan plan_;
  TrainingScans scans_;
};

Calibration Training::describe() const {
  const std::vector<Recording>& recordings = problem_.recordings;
  const Recording& first = recordings.front();
  const std::size_t taxels = first.layout.size.taxels();
  std::vector<bool> trained(classes_.classes.size(), false);
  Calibration calibration;
  calibration.bandwidth_chosen = choosesBandwidth(problem_.options);
  calibration.folds = problem_.options.folds;
  calibration.sensor = identityOf(recordings);
  calibration.layout = first.layout;
  calibration.no_model = unionOfMasks(recordings, taxels);
  calibration.tables = {problem_.options.scheme, first.layout.size, first.full_scale, {}, {}, 0, 0};
  for (const SchemePlan::Model& model : plan_.models) {
    for (const std::size_t curvature_class : model.trained_on) trained[curvature_class] = true;
  }
  calibration.tables.classes = plan_.classes;
  if (!usesCurvature(plan_.scheme)) calibration.tables.classes = {plan_.models.front().answers_for};
  calibration.tables.tables.resize(taxels * calibration.tables.classes.size());
  calibration.trained = findTrainedRanges(recordings, classes_, trained);
  calibration.tables.curvature_low = calibration.trained.curvature.low;
  calibration.tables.curvature_high = calibration.trained.curvature.high;
  calibration.coverage = measureCoverage(recordings, classes_, sections_);
  calibration.provenance = provenanceOf(problem_.recordings, problem_.options);
  const std::size_t cells = taxels * classes_.classes.size() * problem_.options.folds;
  calibration.statistics = {first.full_scale, taxels, problem_.options.folds, classes_.classes,
                            std::vector<CodeStatistics>(cells)};
  calibration.warnings = warningsOf(recordings, sections_);
  return calibration;
}

void Training::sum(std::size_t taxel, Calibration& calibration) const {
  const TrainingStatistics& statistics = calibration.statistics;
  std::vector<CodeStatistics> cells =
      statisticsOfTaxel(scans_, statistics.sections, statistics.full_scale, taxel);
  std::move(cells.begin(), cells.end(),
            calibration.statistics.cells.begin() + static_cast<std::ptrdiff_t>(taxel * cells.size()));
  const auto constant = [&](const SchemePlan::Model& model) { return !varies(statistics, model, taxel); };
  if (std::any_of(plan_.models.begin(), plan_.models.end(), constant)) calibration.no_model[taxel] = 1;
}

void Training::train(std::size_t taxel, const FoldRegressors& regressors, Calibration& calibration,
                     HeldOutScoring& scoring) const {
  const std::size_t classes = calibration.tables.classes.size();
  CodeTable* const tables = &calibration.tables.tables[taxel * classes];
  if (calibration.no_model[taxel] != 0) {
    std::fill(tables, tables + classes, noModel(calibration.tables.full_scale));
    return;
  }
  SectionedReadings readings = readingsOf(calibration.statistics, taxel);
  if (!makeRegressor(regressors.whole)->mergeable()) {
    readings.samples = samplesOfTaxel(scans_, readings.sums.front().size(), readings.full_scale, taxel);
  }
  const bool scores = problem_.options.scores;
  const auto models = crossValidateScheme(plan_, taxel, readings, regressors,
                                          scores ? HeldOutDeviation::kYes : HeldOutDeviation::kNo);
  if (scores) scoring.scoreTaxel(taxel, models);
  for (std::size_t k = 0; k < classes; ++k) tables[k] = models[plan_.model_of_class[k]].table;
}

void Training::warnOfConstantTaxels(Calibration& calibration) const {
  const std::vector<std::uint8_t> masked = unionOfMasks(problem_.recordings, calibration.statistics.taxels);
  const auto& none = calibration.no_model;
  if (std::find(none.begin(), none.end(), 0) == none.end()) {
    throw InputError(problem_.recordings.front().name +
                     ": every taxel is masked or reads the same count throughout; is the matrix connected?");
  }
  std::string constant;
  for (std::size_t taxel = 0; taxel < none.size(); ++taxel) {
    if (none[taxel] != 0 && masked[taxel] == 0)
      constant += (constant.empty() ? "" : ", ") + std::to_string(taxel);
  }
  if (constant.empty()) return;
  calibration.warnings.push_back("these taxels (row * columns + column) read the same count throughout a " +
                                 std::string("condition and get no model: ") + constant);
}

}  // namespace

Calibration calibrate(const CalibrationProblem& problem, const CalibrationProgress& progress) {
  validate(problem);
  return Training(problem).run(progress);
}

}  // namespace fsr
