#pragma once

#include <Eigen/Dense>
#include <vector>

namespace fsr::statistics {

/// Returns the coefficients b that minimise b' G b - 2 b' r. Coefficients that are not `free` must not be
/// negative. G (`gram`) is symmetric and positive semidefinite; r is `right`. The method works on the normal
/// equations. Source: C. Lawson, R. Hanson, Solving Least Squares Problems, 1974, ch. 23.
Eigen::VectorXd solveSigned(const Eigen::MatrixXd& gram, const Eigen::VectorXd& right,
                            const std::vector<bool>& free);

}  // namespace fsr::statistics
