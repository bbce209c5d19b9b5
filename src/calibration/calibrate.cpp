#include <algorithm>
#include <mutex>

#include "fsr_pressure_map/calibration/calibration.h"
#include "fsr_pressure_map/calibration/held_out_scoring.h"
#include "fsr_pressure_map/calibration/sources.h"
#include "fsr_pressure_map/calibration/training_scans.h"
#include "fsr_pressure_map/compensation/scheme_plan.h"
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
    HeldOutScoring scoring(scans_, plan_, problem_.options.folds, calibration.statistics.taxels);
    std::mutex reporting;
    std::size_t done = 0;
    forEachTaxel(calibration.statistics.taxels, problem_.options.threads, [&](std::size_t taxel) {
      train(taxel, calibration, scoring);
      const std::lock_guard<std::mutex> lock(reporting);
      if (progress) progress(++done, calibration.statistics.taxels);
    });
    warnOfConstantTaxels(calibration);
    if (problem_.options.scores) calibration.scores = scoring.summarise(classes_.classes);
    return calibration;
  }

 private:
  // Everything but what is found taxel by taxel.
  Calibration describe() const;
  void train(std::size_t taxel, Calibration& calibration, HeldOutScoring& scoring) const;
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
  calibration.bandwidth = problem_.options.bandwidth;
  calibration.folds = problem_.options.folds;
  calibration.sensor = identityOf(recordings);
  calibration.layout = first.layout;
  calibration.no_model = unionOfMasks(recordings, taxels);
  calibration.tables = {problem_.options.scheme, first.layout.size, first.full_scale, {}, {}, 0, 0};
  for (const SchemePlan::Model& model : plan_.models) {
    calibration.tables.classes.push_back(model.answers_for);
    for (const std::size_t curvature_class : model.trained_on) trained[curvature_class] = true;
  }
  calibration.tables.tables.resize(taxels * plan_.models.size());
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

void Training::train(std::size_t taxel, Calibration& calibration, HeldOutScoring& scoring) const {
  const TrainingStatistics& statistics = calibration.statistics;
  std::vector<CodeStatistics> cells =
      statisticsOfTaxel(scans_, statistics.sections, statistics.full_scale, taxel);
  std::move(cells.begin(), cells.end(),
            calibration.statistics.cells.begin() + static_cast<std::ptrdiff_t>(taxel * cells.size()));
  const auto constant = [&](const SchemePlan::Model& model) { return !varies(statistics, model, taxel); };
  if (std::any_of(plan_.models.begin(), plan_.models.end(), constant)) calibration.no_model[taxel] = 1;

  CodeTable* const tables = &calibration.tables.tables[taxel * plan_.models.size()];
  if (calibration.no_model[taxel] != 0) {
    std::fill(tables, tables + plan_.models.size(), noModel(statistics.full_scale));
    return;
  }
  const HeldOutDeviation deviations =
      problem_.options.scores ? HeldOutDeviation::kYes : HeldOutDeviation::kNo;
  auto models = fitTaxel(plan_, statistics, taxel, Grnn(problem_.options.bandwidth), deviations);
  if (problem_.options.scores) scoring.scoreTaxel(taxel, models);
  for (std::size_t m = 0; m < models.size(); ++m) tables[m] = std::move(models[m].table);
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
