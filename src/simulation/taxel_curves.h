#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace fsr::simulation {

/// Deviations of single taxels from the static curve of the simulation, by surface and pressure. The taxels
/// of a real sheet all have different curves. `discrepancy` fits these deviations.
struct TaxelCurves {
  /// On one surface.
  struct OnSurface {
    double curvature = 0;          ///< principal, of taxel 0 [1/m]
    std::vector<double> pressure;  ///< gauge, ascending [Pa]
    std::vector<double> added;     ///< [pressures x taxels] [share of full scale]
  };
  std::vector<OnSurface> surfaces;  ///< at least one
  std::size_t taxels = 0;

  /// The surface whose curvature is nearest.
  const OnSurface& nearest(double curvature) const;
};

/// Deviation of one taxel at one pressure: linear between the pressures, constant beyond them.
double addedAt(const TaxelCurves::OnSurface& surface, std::size_t taxels, std::size_t taxel, double pressure);

/// As a table: one row for each surface and pressure, one column for each taxel.
std::string taxelCurvesText(const TaxelCurves& curves);
/// Throws InputError that names file, line and column.
TaxelCurves readTaxelCurves(const std::string& path);

}  // namespace fsr::simulation
