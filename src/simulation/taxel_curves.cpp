#include "simulation/taxel_curves.h"

#include <algorithm>
#include <cmath>

#include "dataset/table_reader.h"
#include "settings/yaml_text.h"

namespace fsr::simulation {

namespace {

constexpr std::size_t kLabels = 2;  // columns before the taxels: curvature, pressure

}  // namespace

const TaxelCurves::OnSurface& TaxelCurves::nearest(double curvature) const {
  const auto nearer = [&](const OnSurface& a, const OnSurface& b) {
    return std::abs(a.curvature - curvature) < std::abs(b.curvature - curvature);
  };
  return *std::min_element(surfaces.begin(), surfaces.end(), nearer);
}

double addedAt(const TaxelCurves::OnSurface& surface, std::size_t taxels, std::size_t taxel,
               double pressure) {
  const std::vector<double>& at = surface.pressure;
  const auto above = static_cast<std::size_t>(std::upper_bound(at.begin(), at.end(), pressure) - at.begin());
  const auto added = [&](std::size_t k) { return surface.added[k * taxels + taxel]; };
  if (above == 0) return added(0);
  if (above == at.size()) return added(above - 1);
  const double share = (pressure - at[above - 1]) / (at[above] - at[above - 1]);
  return added(above - 1) + share * (added(above) - added(above - 1));
}

std::string taxelCurvesText(const TaxelCurves& curves) {
  std::string text =
      "# What each taxel reads beyond the static law of the simulation beside this file [share of full "
      "scale]\n"
      "curvature_per_m,pressure_Pa";
  for (std::size_t t = 0; t < curves.taxels; ++t) text += ",taxel_" + std::to_string(t);
  for (const TaxelCurves::OnSurface& surface : curves.surfaces) {
    for (std::size_t k = 0; k < surface.pressure.size(); ++k) {
      text +=
          "\n" + settings::numberText(surface.curvature) + "," + settings::numberText(surface.pressure[k]);
      for (std::size_t t = 0; t < curves.taxels; ++t) {
        text += "," + settings::numberText(surface.added[k * curves.taxels + t]);
      }
    }
  }
  return text + "\n";
}

TaxelCurves readTaxelCurves(const std::string& path) {
  dataset::TableReader table(path);
  TaxelCurves curves;
  if (table.columns() <= kLabels)
    throw settings::InputError(path + ": has no column for a taxel after curvature and pressure");
  curves.taxels = table.columns() - kLabels;
  while (table.next()) {
    const double curvature = table.number(0), pressure = table.number(1);
    if (curves.surfaces.empty() || curves.surfaces.back().curvature != curvature) {
      curves.surfaces.push_back({curvature, {}, {}});
    }
    TaxelCurves::OnSurface& surface = curves.surfaces.back();
    if (!surface.pressure.empty() && pressure <= surface.pressure.back()) {
      throw table.error(1, "must be above the row before it");
    }
    surface.pressure.push_back(pressure);
    for (std::size_t t = 0; t < curves.taxels; ++t) surface.added.push_back(table.number(kLabels + t));
  }
  if (curves.surfaces.empty()) throw settings::InputError(path + ": holds no row");
  return curves;
}

}  // namespace fsr::simulation
