#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace fsr::simulation {

/// Deviations of single taxels from the static curve of the simulation, by surface and load. The load is that
/// which the chain computes, with its history; the deviations are natural cubic splines over it. The taxels
/// of a real sheet all have different curves. `discrepancy` fits these deviations.
struct TaxelCurves {
  /// On one surface.
  struct OnSurface {
    double curvature = 0;       ///< principal, of taxel 0 [1/m]
    std::vector<double> load;   ///< ascending [Pa]
    std::vector<double> added;  ///< [loads x taxels] [share of full scale]
  };
  std::vector<OnSurface> surfaces;  ///< at least one
  std::size_t taxels = 0;

  /// Index of the surface whose curvature is nearest.
  std::size_t nearestIndex(double curvature) const;
};

/// Second derivatives at the knots of a natural cubic spline, as a linear function of its values at the
/// knots, [knots x knots] row-major. `knots` ascend. Source: P. Green, B. Silverman, Nonparametric Regression
/// and Generalized Linear Models, Chapman and Hall 1994, ch. 2.
std::vector<double> splineBends(const std::vector<double>& knots);

/// The weights of a natural cubic spline at one place: value = below * f(k) + above * f(k + 1) + below_bend *
/// f''(k) + above_bend * f''(k + 1), with k = `knot`. Beyond its ends the spline is a straight line.
struct SplineWeights {
  std::size_t knot = 0;
  double below = 1, above = 0, below_bend = 0, above_bend = 0;
};
/// `knots`: at least two, ascending.
SplineWeights splineWeights(const std::vector<double>& knots, double at);

/// The deviations on one surface as functions of the load: natural cubic splines through the table, straight
/// lines beyond its ends.
class LoadCurves {
 public:
  LoadCurves(const TaxelCurves::OnSurface& surface, std::size_t taxels);

  /// Deviation of one taxel at one load [share of full scale].
  double at(std::size_t taxel, double load) const;

 private:
  std::vector<double> knots_;
  std::size_t taxels_;
  std::vector<double> values_, bends_;  // [knots x taxels]
};

/// As a table: one row for each surface and load, one column for each taxel.
std::string taxelCurvesText(const TaxelCurves& curves);
/// Throws InputError that names file, line and column.
TaxelCurves readTaxelCurves(const std::string& path);

}  // namespace fsr::simulation
