#pragma once

#include <Eigen/Dense>
#include <functional>
#include <optional>
#include <vector>

namespace fsr::discrepancy {

/// Residuals at a point; none where the point is not permitted.
using Residuals = std::function<std::optional<Eigen::VectorXd>(const std::vector<double>& at)>;

struct LevenbergOptions {
  int steps = 6;
  double difference = 0.02;  ///< for derivatives; coordinates are scaled so that 1 is large
  double enough = 1e-4;      ///< share of the squared error that a step must gain to go on
};

/// Where the residuals' squares are least, from `start` on; `start` itself where it is not permitted.
/// Sources: K. Levenberg 1944, D. Marquardt 1963.
std::vector<double> levenberg(const Residuals& residuals, std::vector<double> start,
                              const LevenbergOptions& options = {});

/// Derivatives of the residuals by differences, [residuals x coordinates].
Eigen::MatrixXd derivatives(const Residuals& residuals, const std::vector<double>& at,
                            const Eigen::VectorXd& there, double difference);

}  // namespace fsr::discrepancy
