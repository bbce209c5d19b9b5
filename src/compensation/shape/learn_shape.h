#pragma once

#include <Eigen/Dense>
#include <vector>

#include "fsr_pressure_map/compensation/shape.h"

namespace fsr::compensation {

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
ShapeLaw learnLaw(const ShapeModel& model);

}  // namespace fsr::compensation
