#include "fsr_pressure_map/compensation/scheme_plan.h"

#include <numeric>

#include "fsr_pressure_map/settings/input_error.h"

namespace fsr {

namespace {

std::string listOf(const std::vector<CurvatureClass>& classes) {
  std::string list;
  for (const CurvatureClass& curvature_class : classes) {
    list += (list.empty() ? "" : ", ") + curvature_class.surface;
  }
  return list;
}

// One model answers everywhere.
SchemePlan oneModel(const CurvatureClass& answers_for, std::vector<std::size_t> trained_on,
                    std::size_t classes) {
  return {{{answers_for, std::move(trained_on)}}, std::vector<std::size_t>(classes, 0)};
}

SchemePlan planFlatOnly(const std::vector<CurvatureClass>& classes) {
  std::vector<std::size_t> flat;
  for (std::size_t i = 0; i < classes.size(); ++i) {
    if (isFlat(classes[i])) flat.push_back(i);
  }
  if (flat.empty()) {
    throw InputError("scheme is flat_only, but no recording is of a flat surface (there is " +
                     listOf(classes) + "); add one, or choose baseline or per_curvature");
  }
  return oneModel(classes[flat.front()], flat, classes.size());
}

SchemePlan planBaseline(const std::vector<CurvatureClass>& classes) {
  std::vector<std::size_t> all(classes.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  return oneModel({"all surfaces", {0.0}}, all, classes.size());
}

SchemePlan planPerCurvature(const std::vector<CurvatureClass>& classes) {
  SchemePlan plan;
  for (std::size_t i = 0; i < classes.size(); ++i) {
    plan.models.push_back({classes[i], {i}});
    plan.model_of_class.push_back(i);
  }
  return plan;
}

// The statistics of a model's classes, section by section.
std::vector<CodeStatistics> pooledSections(const SchemePlan::Model& model,
                                           const TrainingStatistics& statistics, std::size_t taxel) {
  std::vector<CodeStatistics> sections(statistics.sections);
  for (std::size_t section = 0; section < sections.size(); ++section) {
    for (const std::size_t curvature_class : model.trained_on) {
      sections[section].merge(statistics.cell(taxel, curvature_class, section));
    }
  }
  return sections;
}

}  // namespace

SchemePlan planScheme(Scheme scheme, const std::vector<CurvatureClass>& classes) {
  switch (scheme) {
    case Scheme::kFlatOnly:
      return planFlatOnly(classes);
    case Scheme::kBaseline:
      return planBaseline(classes);
    case Scheme::kPerCurvature:
      return planPerCurvature(classes);
  }
  throw InputError("this scheme has no plan");
}

std::vector<CrossValidatedModel> fitTaxel(const SchemePlan& plan, const TrainingStatistics& statistics,
                                          std::size_t taxel, const Regressor& regressor,
                                          HeldOutDeviation held_out_deviation) {
  std::vector<CrossValidatedModel> models;
  for (const SchemePlan::Model& model : plan.models) {
    models.push_back(crossValidate(pooledSections(model, statistics, taxel), statistics.full_scale, regressor,
                                   held_out_deviation));
  }
  return models;
}

}  // namespace fsr
