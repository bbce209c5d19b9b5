#include "fsr_pressure_map/compensation/scheme.h"

#include <array>
#include <utility>

#include "fsr_pressure_map/settings/input_error.h"

namespace fsr {

namespace {

constexpr std::array<std::pair<Scheme, const char*>, 3> kNames = {{
    {Scheme::kFlatOnly, "flat_only"},
    {Scheme::kBaseline, "baseline"},
    {Scheme::kPerCurvature, "per_curvature"},
}};

}  // namespace

std::string schemeName(Scheme scheme) {
  for (const auto& [known, name] : kNames) {
    if (known == scheme) return name;
  }
  return "unknown";
}

std::vector<std::string> schemeNames() {
  std::vector<std::string> names;
  for (const auto& entry : kNames) names.emplace_back(entry.second);
  return names;
}

Scheme schemeFromName(const std::string& name) {
  std::string known;
  for (const auto& entry : kNames) {
    if (name == entry.second) return entry.first;
    known += (known.empty() ? "" : ", ") + std::string(entry.second);
  }
  throw InputError("scheme is \"" + name + "\", but must be one of " + known);
}

bool usesCurvature(Scheme scheme) {
  return scheme == Scheme::kPerCurvature;
}

}  // namespace fsr
