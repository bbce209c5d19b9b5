#include "calibration/stages/tables/taxel_training.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "compensation/effect_law.h"
#include "compensation/learn_scheme.h"
#include "compensation/training_statistics.h"
#include "compensation/unseen_curvature.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "matrix/for_each_taxel.h"
#include "regression/bandwidth_search.h"
#include "regression/regressors.h"
#include "settings/progress.h"

namespace fsr::calibration {

namespace {

std::vector<regression::CodeStatistics> sectionsOf(const std::vector<std::size_t>& classes,
                                                   const compensation::TrainingStatistics& statistics,
                                                   std::size_t taxel) {
  std::vector<regression::CodeStatistics> sections(statistics.sections);
  for (std::size_t section = 0; section < sections.size(); ++section) {
    for (const std::size_t k : classes) sections[section].merge(statistics.cell(taxel, k, section));
  }
  return sections;
}

// Errors of all models of one taxel.
regression::BandwidthErrors errorsOf(const regression::GrnnOptions& options,
                                     const compensation::SchemePlan& plan,
                                     const compensation::TrainingStatistics& statistics, std::size_t taxel) {
  regression::GrnnOptions alike = options;
  alike.weighting = regression::SampleWeighting::kEachSample;
  const auto errors = [&](std::size_t model) {
    return regression::BandwidthErrors(sectionsOf(plan.testedOn(model), statistics, taxel),
                                       statistics.full_scale, alike, regression::bandwidthGrid());
  };
  regression::BandwidthErrors all = errors(0);
  for (std::size_t model = 1; model < plan.models.size(); ++model) all.add(errors(model));
  return all;
}

}  // namespace

std::vector<std::size_t> taxelsOfSearch(const std::vector<std::uint8_t>& no_model) {
  std::vector<std::size_t> taxels;
  for (std::size_t taxel = 0; taxel < no_model.size(); ++taxel) {
    if (no_model[taxel] == 0) taxels.push_back(taxel);
  }
  const std::size_t number = std::min(taxels.size(), kTaxelsOfSearch);
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < number; ++i) chosen.push_back(taxels[i * taxels.size() / number]);
  return chosen;
}

bool choosesBandwidth(const CalibrationOptions& options) {
  return options.choose_bandwidth && options.regressor.name == "grnn";
}

compensation::FoldRegressors chooseRegressor(const CalibrationOptions& options,
                                             const compensation::SchemePlan& plan,
                                             const compensation::TrainingStatistics& statistics,
                                             const std::vector<std::uint8_t>& no_model,
                                             const CalibrationProgress& progress) {
  compensation::FoldRegressors regressors{options.regressor, {}};
  regressors.whole.forest.seed = options.seed;
  if (!choosesBandwidth(options)) return regressors;
  const std::vector<std::size_t> taxels = taxelsOfSearch(no_model);
  std::vector<std::unique_ptr<regression::BandwidthErrors>> errors(taxels.size());
  settings::StepProgress search(progress, "choosing the bandwidth", taxels.size());
  matrix::forEachTaxel(taxels.size(), options.threads, [&](std::size_t i) {
    errors[i] = std::make_unique<regression::BandwidthErrors>(
        errorsOf(options.regressor.grnn, plan, statistics, taxels[i]));
    search.partDone();
  });
  for (std::size_t i = 1; i < errors.size(); ++i) errors.front()->add(*errors[i]);  // always in this order
  regressors.whole.grnn.bandwidth = errors.front()->best();
  regressors.without.assign(statistics.sections, regressors.whole);
  for (std::size_t section = 0; section < statistics.sections; ++section) {
    regressors.without[section].grnn.bandwidth = errors.front()->best(section);
  }
  return regressors;
}

namespace {

// Length scale of a GRNN on curvature: its own, if it has one, else its bandwidth in units of the standard
// deviation of the training curvatures.
double lengthScale(const compensation::SchemePlan& plan, const regression::RegressorOptions& regressor,
                   const compensation::TrainingStatistics& statistics, std::size_t taxel) {
  if (plan.curvature_scale > 0) return plan.curvature_scale;
  std::vector<double> curvature;
  std::vector<std::uint64_t> readings;
  for (std::size_t k = 0; k < statistics.classes.size(); ++k) {
    curvature.push_back(statistics.classes[k].at(taxel));
    readings.push_back(0);
    for (std::size_t s = 0; s < statistics.sections; ++s)
      readings[k] += statistics.cell(taxel, k, s).samples();
  }
  const regression::ClassInputs inputs = compensation::classInputs(plan.scheme, curvature, {}, readings);
  const double sigma = regression::entryOf(regressor).second_input->sigma(regressor);
  return inputs.scale.front() > 0 ? sigma / inputs.scale.front() : INFINITY;
}

std::vector<double> lengthScales(const compensation::SchemePlan& plan,
                                 const regression::RegressorOptions& regressor,
                                 const compensation::TrainingStatistics& statistics) {
  std::vector<double> scales;
  for (std::size_t taxel = 0; taxel < statistics.taxels; ++taxel) {
    scales.push_back(lengthScale(plan, regressor, statistics, taxel));
  }
  if (std::all_of(scales.begin(), scales.end(), [&](double scale) { return scale == scales.front(); })) {
    scales.resize(1);
  }
  return scales;
}

}  // namespace

UnseenScore learnRule(const compensation::SchemePlan& plan, unsigned threads, Calibration& calibration) {
  const compensation::TrainingStatistics& statistics = *calibration.statistics;
  compensation::CurvatureTables& tables = calibration.tables;
  if (!compensation::usesCurvature(plan.scheme)) return {};
  tables.rule.blend = compensation::blendOf(plan.scheme, calibration.regressor);
  const std::size_t classes = tables.classes.size();
  if (plan.models.size() < classes) tables.rule.model_of_class = plan.model_of_class;
  if (tables.rule.blend == compensation::BlendRule::kKernel) {
    tables.rule.length_scale = lengthScales(plan, calibration.regressor, statistics);
  }
  std::vector<compensation::EffectLaw> law_without;
  if (plan.scheme == compensation::Scheme::kCurvatureMap) {
    std::vector<compensation::TaxelEffect> effects;
    for (std::size_t t = 0; t < statistics.taxels; ++t)
      effects.push_back(compensation::effectOf(&tables.table(t, 0), classes));
    tables.rule.law = compensation::learnLaw(tables.classes, effects);
    for (std::size_t k = 0; k < classes; ++k)
      law_without.push_back(compensation::learnLaw(tables.classes, effects, k));
  }
  std::vector<compensation::UnseenErrors> errors(statistics.taxels);
  matrix::forEachTaxel(statistics.taxels, threads, [&](std::size_t taxel) {
    if (std::isnan(tables.table(taxel, 0).pressure.front())) return;
    errors[taxel] = compensation::leaveClassesOut(tables, taxel, statistics, law_without);
  });
  tables.rule.unseen = compensation::unseenDeviation(errors);
  const compensation::UnseenSummary summary = compensation::summaryOf(errors);
  return {summary.readings, summary.rmse_percent, summary.rmse};
}

namespace {

constexpr char kConstantTaxels[] =
    "these taxels (row * columns + column) read the same count throughout a condition and get no model: ";

// Whether the reading changes. One that does not contains no information.
bool varies(const compensation::TrainingStatistics& statistics, const compensation::SchemePlan::Model& model,
            std::size_t taxel) {
  TrainedInterval codes;
  for (const std::size_t curvature_class : model.trained_on) {
    for (std::size_t section = 0; section < statistics.sections; ++section) {
      const regression::CodeStatistics& cell = statistics.cell(taxel, curvature_class, section);
      if (cell.empty()) continue;
      codes.include(cell.code().front());
      codes.include(cell.code().back());
    }
  }
  return codes.low < codes.high;
}

std::uint64_t scansOf(const compensation::TrainingStatistics& statistics,
                      const compensation::SchemePlan::Model& model) {
  std::uint64_t scans = 0;
  for (const std::size_t k : model.trained_on) {
    for (std::size_t section = 0; section < statistics.sections; ++section) {
      scans += statistics.cell(0, k, section).samples();
    }
  }
  return scans;
}

// Called if no taxel has a model. Throws if one of several surfaces is the reason.
void refuseStillSurface(const compensation::SchemePlan& plan, const Calibration& calibration) {
  const std::size_t taxels = calibration.masked.size();
  std::vector<const compensation::SchemePlan::Model*> still;
  for (const compensation::SchemePlan::Model& model : plan.models) {
    bool any = false;
    for (std::size_t taxel = 0; taxel < taxels && !any; ++taxel) {
      any = calibration.masked[taxel] == 0 && varies(*calibration.statistics, model, taxel);
    }
    if (!any) still.push_back(&model);
  }
  if (still.empty() || still.size() == plan.models.size()) return;
  const std::uint64_t scans = scansOf(*calibration.statistics, *still.front());
  throw settings::InputError("\"" + still.front()->answers_for.surface +
                             "\": every taxel reads the same count throughout (" + std::to_string(scans) +
                             (scans == 1 ? " scan" : " scans") +
                             "), so that there is nothing to train on; record it again, or leave it out");
}

regression::CodeTable noModel(std::uint16_t full_scale, bool kernels) {
  regression::CodeTable table;
  table.pressure.assign(full_scale + 1u, std::numeric_limits<float>::quiet_NaN());
  table.deviation = table.support = table.pressure;
  if (kernels) table.log_weight = table.pressure;
  return table;
}

// If kernels are blended, the tables are those of the single classes.
void useKernels(const regression::ClassReadings& readings, const regression::RegressorOptions& regressor,
                regression::CodeTable* tables) {
  const std::vector<regression::KernelMean> means =
      regression::entryOf(regressor).second_input->kernels(readings, regressor);
  for (std::size_t k = 0; k < means.size(); ++k) {
    tables[k].pressure.assign(means[k].pressure.begin(), means[k].pressure.end());
    tables[k].log_weight.assign(means[k].log_weight.begin(), means[k].log_weight.end());
  }
}

// The model with which the parameters of schemes are found.
regression::GrnnOptions plainKernel(const regression::GrnnOptions& options) {
  regression::GrnnOptions plain;
  plain.bandwidth = options.bandwidth;
  plain.spread = options.spread;
  return plain;
}

}  // namespace

void prepareTables(const compensation::SchemePlan& plan, Calibration& calibration) {
  compensation::CurvatureTables& tables = calibration.tables;
  tables.scheme = plan.scheme;
  tables.size = calibration.layout.size;
  tables.full_scale = calibration.statistics->full_scale;
  tables.classes = plan.classes;
  if (!compensation::usesCurvature(plan.scheme)) tables.classes = {plan.models.front().answers_for};
  tables.tables.resize(tables.size.taxels() * tables.classes.size());
  tables.curvature_low = calibration.trained.curvature.low;
  tables.curvature_high = calibration.trained.curvature.high;
}

void findTaxelsWithoutModel(const compensation::SchemePlan& plan, const std::string& origin,
                            Calibration& calibration) {
  calibration.no_model = calibration.masked;
  std::string constant;
  for (std::size_t taxel = 0; taxel < calibration.no_model.size(); ++taxel) {
    const auto varying = [&](const auto& model) { return varies(*calibration.statistics, model, taxel); };
    if (calibration.masked[taxel] != 0) continue;
    if (std::all_of(plan.models.begin(), plan.models.end(), varying)) continue;
    calibration.no_model[taxel] = 1;
    constant += (constant.empty() ? "" : ", ") + std::to_string(taxel);
  }
  const auto& none = calibration.no_model;
  if (std::find(none.begin(), none.end(), 0) == none.end()) {
    refuseStillSurface(plan, calibration);
    throw settings::InputError(
        origin + ": every taxel is masked or reads the same count throughout; is the matrix connected?");
  }
  if (!constant.empty()) calibration.warnings.push_back(kConstantTaxels + constant);
}

bool isConstantTaxelWarning(const std::string& warning) {
  return warning.rfind(kConstantTaxels, 0) == 0;
}

compensation::SectionedReadings readingsOf(const compensation::TrainingStatistics& statistics,
                                           std::size_t taxel) {
  compensation::SectionedReadings readings;
  readings.full_scale = statistics.full_scale;
  for (std::size_t k = 0; k < statistics.classes.size(); ++k) {
    const regression::CodeStatistics* const first = &statistics.cell(taxel, k, 0);
    readings.sums.emplace_back(first, first + statistics.sections);
  }
  return readings;
}

compensation::FoldRegressors choose(const CalibrationOptions& options, Calibration& calibration,
                                    compensation::SchemePlan& plan, const CalibrationProgress& progress) {
  const compensation::FoldRegressors regressors =
      chooseRegressor(options, plan, *calibration.statistics, calibration.no_model, progress);
  calibration.regressor = regressors.whole;
  compensation::learnScheme(*calibration.statistics, plainKernel(regressors.whole.grnn),
                            taxelsOfSearch(calibration.no_model), options.threads, plan);
  return regressors;
}

void fillTables(const compensation::SchemePlan& plan, std::size_t taxel,
                const std::vector<regression::CrossValidatedModel>& models, Calibration& calibration) {
  const std::size_t classes = calibration.tables.classes.size();
  regression::CodeTable* const tables = &calibration.tables.tables[taxel * classes];
  const bool kernels =
      compensation::blendOf(plan.scheme, calibration.regressor) == compensation::BlendRule::kKernel;
  for (std::size_t k = 0; k < classes; ++k) {
    tables[k] = models.empty() ? noModel(calibration.tables.full_scale, kernels)
                               : models[plan.model_of_class[k]].table;
  }
  if (kernels && !models.empty()) {
    useKernels(compensation::allSections(readingsOf(*calibration.statistics, taxel)), calibration.regressor,
               tables);
  }
}

void trainOnStatistics(const CalibrationOptions& options, const std::string& origin,
                       Calibration& calibration) {
  const compensation::TrainingStatistics& statistics = *calibration.statistics;
  compensation::SchemePlan plan = compensation::planScheme(options.scheme, statistics.classes);
  for (const compensation::SchemePlan::Model& model : plan.models) {
    for (const std::size_t k : model.trained_on) {
      for (const double curvature : plan.classes[k].curvature)
        calibration.trained.curvature.include(curvature);
    }
  }
  prepareTables(plan, calibration);
  findTaxelsWithoutModel(plan, origin, calibration);
  const compensation::FoldRegressors regressors = choose(options, calibration, plan, {});
  matrix::forEachTaxel(statistics.taxels, options.threads, [&](std::size_t taxel) {
    std::vector<regression::CrossValidatedModel> models;
    if (calibration.no_model[taxel] == 0) {
      models = compensation::crossValidateScheme(plan, taxel, readingsOf(statistics, taxel), regressors,
                                                 regression::HeldOutDeviation::kNo);
    }
    fillTables(plan, taxel, models, calibration);
  });
  learnRule(plan, options.threads, calibration);
}

}  // namespace fsr::calibration
