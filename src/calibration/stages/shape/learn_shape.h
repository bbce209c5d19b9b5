#pragma once

#include <Eigen/Dense>
#include <functional>
#include <vector>

#include "calibration/stages/shape/read_shape.h"
#include "fsr_pressure_map/calibration/shape.h"

namespace fsr::calibration {

enum class SearchScale { kLinear, kLogarithmic };

/// A parameter that is searched between two values.
struct Searched {
  double* value;
  double low, high;
  SearchScale scale = SearchScale::kLogarithmic;
};

/// Minimises `cost` along each parameter in turn (R. P. Brent, Algorithms for Minimization Without
/// Derivatives, 1973), until a round over all parameters gains less than a thousandth. Leaves the parameters
/// at the minimum and returns it.
double search(const std::vector<Searched>& parameters, const std::function<double()>& cost);

/// The readings at rest on one surface.
struct SurfaceRests {
  Eigen::MatrixXd pressure;  ///< [mounts x taxels that take part] [Pa]
  double gain = 1;           ///< see ShapeModel
  double zero_share = 0;     ///< share of the readings that are 0
};

/// Surfaces with a larger share of readings that are 0 say little of how mounts differ: where readings are
/// cut, mounts look alike.
constexpr double kMostZeros = 0.02;

/// Learns how much mounts of one surface differ, by maximum likelihood on the differences between mounts
/// (restricted likelihood; H. D. Patterson, R. Thompson, Biometrika 58, 1971). Surfaces on which more than
/// kMostZeros of the readings are 0 are left out. `contrasts` of the result is 0 if nothing can be learnt.
MountScatter learnScatter(const std::vector<SurfaceRests>& surfaces,
                          const std::vector<matrix::Position>& places);

/// Learns the law over curvature by maximum likelihood on the means of the surfaces. `model` must have
/// everything but its law.
ShapeLaw learnShapeLaw(const ShapeModel& model);

/// Tells whether the bend changes along the sheet: the most likely centre and changes along both axes,
/// against the constant bend of `constant` (likelihood ratio with two degrees of freedom). Deviations follow
/// from the curvature of the likelihood there. `model` must be that of the reader. Throws as
/// ShapeReader::estimate().
ChangingBend tellBendChange(const ShapeReader& reader, const ShapeModel& model, const RestReading& rest,
                            const ShapeEstimate& constant);

}  // namespace fsr::calibration
