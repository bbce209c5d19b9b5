#include "calibration/curvature_rule_learning.h"

#include <algorithm>
#include <cmath>

#include "compensation/effect_law.h"
#include "compensation/fit_scheme.h"
#include "compensation/unseen_curvature.h"
#include "matrix/for_each_taxel.h"

namespace fsr::calibration {

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

}  // namespace fsr::calibration
