#include "compensation/scheme_plan.h"

#include <algorithm>
#include <numeric>

#include "fsr_pressure_map/settings/input_error.h"

namespace fsr::compensation {

namespace {

using Indices = std::vector<std::size_t>;

std::string listOf(const std::vector<dataset::CurvatureClass>& classes) {
  std::string list;
  for (const dataset::CurvatureClass& curvature_class : classes) {
    list += (list.empty() ? "" : ", ") + curvature_class.surface;
  }
  return list;
}

Indices allOf(const std::vector<dataset::CurvatureClass>& classes) {
  Indices all(classes.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  return all;
}

Indices classesThatAre(bool flat, const std::vector<dataset::CurvatureClass>& classes) {
  Indices found;
  for (std::size_t k = 0; k < classes.size(); ++k) {
    if (dataset::isFlat(classes[k]) == flat) found.push_back(k);
  }
  return found;
}

Indices flatClasses(Scheme scheme, const std::vector<dataset::CurvatureClass>& classes) {
  Indices flat = classesThatAre(true, classes);
  if (flat.empty()) {
    throw settings::InputError("scheme is " + schemeName(scheme) +
                               ", but no recording is of a flat surface (there is " + listOf(classes) +
                               "); add one, or choose baseline or per_curvature");
  }
  return flat;
}

// Plans one model that answers everywhere.
void planOneModel(const dataset::CurvatureClass& answers_for, Indices trained_on, SchemePlan& plan) {
  plan.models = {{answers_for, std::move(trained_on)}};
  plan.model_of_class.assign(plan.classes.size(), 0);
}

void planEachClass(bool trained_on_all, SchemePlan& plan) {
  plan.model_of_class = allOf(plan.classes);
  for (const std::size_t k : plan.model_of_class) {
    plan.models.push_back({plan.classes[k], trained_on_all ? plan.model_of_class : Indices{k}});
  }
}

void planFlatAndBent(bool trained_on_all, SchemePlan& plan) {
  const Indices flat = flatClasses(plan.scheme, plan.classes), bent = classesThatAre(false, plan.classes);
  if (bent.empty()) {
    throw settings::InputError("scheme is " + schemeName(plan.scheme) +
                               ", but no recording is of a bent surface; add one, or choose flat_only");
  }
  const Indices all = allOf(plan.classes);
  plan.models.push_back({plan.classes[flat.front()], trained_on_all ? all : flat});
  plan.models.push_back({plan.classes[bent.front()], trained_on_all ? all : bent});
  plan.models.back().answers_for.surface = "bent surfaces";
  plan.model_of_class.assign(plan.classes.size(), 1);
  for (const std::size_t k : flat) plan.model_of_class[k] = 0;
}

}  // namespace

bool SchemePlan::trainsOn(std::size_t curvature_class) const {
  const std::vector<std::size_t>& trained_on = models[model_of_class[curvature_class]].trained_on;
  return std::binary_search(trained_on.begin(), trained_on.end(), curvature_class);
}

std::vector<std::size_t> SchemePlan::testedOn(std::size_t model) const {
  std::vector<std::size_t> tested;
  for (const std::size_t k : models[model].trained_on) {
    if (model_of_class[k] == model) tested.push_back(k);
  }
  return tested;
}

SchemePlan planScheme(Scheme scheme, const std::vector<dataset::CurvatureClass>& classes) {
  SchemePlan plan{scheme, classes, {}, {}};
  switch (scheme) {
    case Scheme::kFlatOnly: {
      const Indices flat = flatClasses(scheme, classes);
      planOneModel(classes[flat.front()], flat, plan);
      break;
    }
    case Scheme::kBaseline:
      planOneModel({"all surfaces", {0.0}}, allOf(classes), plan);
      break;
    case Scheme::kPerCurvature:
    case Scheme::kCurvatureMap:
    case Scheme::kCurvatureRanges:
    case Scheme::kInterpolated:
    case Scheme::kPerSurface:
      planEachClass(false, plan);
      break;
    case Scheme::kScaledCurvature:
    case Scheme::kCurvatureInput:
    case Scheme::kOneHot:
      planEachClass(true, plan);
      break;
    case Scheme::kFlatOrCurved:
      planFlatAndBent(false, plan);
      break;
    case Scheme::kBinaryInput:
      planFlatAndBent(true, plan);
      break;
  }
  return plan;
}

dataset::PooledBy poolingOf(Scheme scheme) {
  return scheme == Scheme::kPerSurface ? dataset::PooledBy::kName : dataset::PooledBy::kCurvature;
}

void planRanges(const std::vector<std::vector<std::size_t>>& ranges, SchemePlan& plan) {
  plan.models.clear();
  for (const Indices& range : ranges) {
    dataset::CurvatureClass answers_for = plan.classes[range.front()];
    if (range.size() > 1) answers_for.surface += " to " + plan.classes[range.back()].surface;
    for (const std::size_t k : range) plan.model_of_class[k] = plan.models.size();
    plan.models.push_back({answers_for, range});
  }
}

}  // namespace fsr::compensation
