#include "compensation/scheme_plan.h"

#include <algorithm>
#include <array>
#include <numeric>

#include "fsr_pressure_map/settings/input_error.h"

namespace fsr::compensation {

namespace {

struct Entry {
  Scheme scheme;
  const char* name;
  const char* in_paper;
};

constexpr char kBeyond[] = "not in the paper";

constexpr std::array<Entry, 12> kEntries = {{
    {Scheme::kFlatOnly, "flat_only", "Table 2, flat"},
    {Scheme::kBaseline, "baseline", "baseline"},
    {Scheme::kPerCurvature, "per_curvature", "method 1"},
    {Scheme::kCurvatureInput, "curvature_input", "method 2"},
    {Scheme::kOneHot, "one_hot", "method 2, one-hot"},
    {Scheme::kFlatOrCurved, "flat_or_curved", "method 3"},
    {Scheme::kBinaryInput, "binary_input", "method 4"},
    {Scheme::kScaledCurvature, "scaled_curvature", kBeyond},
    {Scheme::kCurvatureMap, "curvature_map", kBeyond},
    {Scheme::kCurvatureRanges, "curvature_ranges", kBeyond},
    {Scheme::kInterpolated, "interpolated", kBeyond},
    {Scheme::kPerSurface, "per_surface", kBeyond},
}};

const Entry& entryOf(Scheme scheme) {
  for (const Entry& entry : kEntries) {
    if (entry.scheme == scheme) return entry;
  }
  throw settings::InputError("scheme number " + std::to_string(static_cast<int>(scheme)) + " has no name");
}

}  // namespace

std::string schemeName(Scheme scheme) {
  return entryOf(scheme).name;
}

std::string schemeInPaper(Scheme scheme) {
  return entryOf(scheme).in_paper;
}

std::vector<std::string> schemeNames() {
  std::vector<std::string> names;
  for (const Entry& entry : kEntries) names.emplace_back(entry.name);
  return names;
}

std::string schemeList() {
  std::string list;
  for (const Entry& entry : kEntries) {
    list += (list.empty() ? "" : ", ") + std::string(entry.name) + " (" + entry.in_paper + ")";
  }
  return list;
}

Scheme schemeFromName(const std::string& name) {
  std::string known;
  for (const Entry& entry : kEntries) {
    if (name == entry.name) return entry.scheme;
    known += (known.empty() ? "" : ", ") + std::string(entry.name);
  }
  throw settings::InputError("scheme is \"" + name + "\", but must be one of " + known);
}

bool usesCurvature(Scheme scheme) {
  return scheme != Scheme::kFlatOnly && scheme != Scheme::kBaseline;
}

bool hasSecondInput(Scheme scheme) {
  return scheme == Scheme::kCurvatureInput || scheme == Scheme::kOneHot || scheme == Scheme::kBinaryInput ||
         scheme == Scheme::kScaledCurvature;
}

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
