#pragma once

#include <Eigen/Dense>
#include <functional>
#include <optional>
#include <vector>

#include "discrepancy/fit/static_fit.h"
#include "discrepancy/samples/measured.h"

namespace fsr::discrepancy {

/// Returns the residuals at a point, or none if the point is not permitted.
using Residuals = std::function<std::optional<Eigen::VectorXd>(const std::vector<double>& at)>;

struct LevenbergOptions {
  int steps = 6;
  double difference = 0.02;  ///< step for derivatives; coordinates are scaled so that 1 is large
  double enough = 1e-4;      ///< share of the squared error; a step that gains less is the last one
};

/// Returns the point where the sum of squared residuals is least, searched from `start`. Returns `start`
/// itself if it is not permitted. Sources: K. Levenberg 1944, D. Marquardt 1963.
std::vector<double> levenberg(const Residuals& residuals, std::vector<double> start,
                              const LevenbergOptions& options = {});

/// Derivatives of the residuals by finite differences, [residuals x coordinates].
Eigen::MatrixXd derivatives(const Residuals& residuals, const std::vector<double>& at,
                            const Eigen::VectorXd& there, double difference);

/// Fits the base parameters of the simulation to the recordings: static curve, preload and gain by bending
/// where they are enabled, and the scatter of the taxels. A user's matrix never has exactly the parameters
/// in the settings file. All other enabled effects keep their values.
simulation::SimulationSettings fitBase(const Measured& measured, const StaticFit& fit,
                                       const simulation::SimulationSettings& settings);

}  // namespace fsr::discrepancy
