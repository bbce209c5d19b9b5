#include "calibration/taxel_training.h"

#include <algorithm>
#include <limits>

#include "calibration/bandwidth_choice.h"
#include "calibration/curvature_rule_learning.h"
#include "compensation/learn_scheme.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "matrix/for_each_taxel.h"
#include "regression/regressors.h"

namespace fsr::calibration {

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
