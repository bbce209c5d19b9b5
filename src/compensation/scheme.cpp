#include "fsr_pressure_map/compensation/scheme.h"

#include <array>

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

}  // namespace fsr::compensation
