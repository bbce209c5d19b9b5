#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace fsr::simulation {

/// What single taxels read beyond the simulation's static law, by surface and pressure: no two taxels of a
/// sheet have one law, and a model of a real sheet needs all of them. Fitted by `discrepancy`.
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

/// Of one taxel at one pressure: straight between the pressures, held beyond them.
double addedAt(const TaxelCurves::OnSurface& surface, std::size_t taxels, std::size_t taxel, double pressure);

/// As a table: one row for each surface and pressure, one column for each taxel.
std::string taxelCurvesText(const TaxelCurves& curves);
/// Throws InputError that names file, line and column.
TaxelCurves readTaxelCurves(const std::string& path);

}  // namespace fsr::simulation
