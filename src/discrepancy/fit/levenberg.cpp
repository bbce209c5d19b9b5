#include "discrepancy/fit/levenberg.h"

namespace fsr::discrepancy {

namespace {

constexpr int kTries = 4;

// Takes a damped step that lowers the error. Returns none if no damping that is tried lowers it.
std::optional<std::pair<std::vector<double>, Eigen::VectorXd>> betterPoint(const Residuals& residuals,
                                                                           const std::vector<double>& at,
                                                                           const Eigen::VectorXd& now,
                                                                           const Eigen::MatrixXd& jacobian,
                                                                           double& damping) {
  const Eigen::MatrixXd normal = jacobian.transpose() * jacobian;
  const Eigen::VectorXd right = -jacobian.transpose() * now;
  for (int attempt = 0; attempt < kTries; ++attempt) {
    Eigen::MatrixXd damped = normal;
    damped.diagonal() *= 1 + damping;
    damped.diagonal().array() += 1e-12 * normal.diagonal().maxCoeff() + 1e-300;
    const Eigen::VectorXd move = damped.ldlt().solve(right).cwiseMax(-1).cwiseMin(1);
    std::vector<double> next = at;
    for (std::size_t k = 0; k < next.size(); ++k) next[k] += move[static_cast<Eigen::Index>(k)];
    const auto there = residuals(next);
    const bool better = there && there->squaredNorm() < now.squaredNorm();
    damping *= better ? 0.3 : 8;
    if (better) return std::make_pair(next, *there);
  }
  return std::nullopt;
}

}  // namespace

Eigen::MatrixXd derivatives(const Residuals& residuals, const std::vector<double>& at,
                            const Eigen::VectorXd& there, double difference) {
  Eigen::MatrixXd slopes = Eigen::MatrixXd::Zero(there.size(), static_cast<Eigen::Index>(at.size()));
  for (std::size_t k = 0; k < at.size(); ++k) {
    for (const double step : {difference, -difference}) {
      std::vector<double> beside = at;
      beside[k] += step;
      const auto value = residuals(beside);
      if (!value) continue;
      slopes.col(static_cast<Eigen::Index>(k)) = (*value - there) / step;
      break;
    }
  }
  return slopes;
}

std::vector<double> levenberg(const Residuals& residuals, std::vector<double> at,
                              const LevenbergOptions& options) {
  auto now = residuals(at);
  double damping = 1e-2;
  for (int step = 0; now && step < options.steps; ++step) {
    const Eigen::MatrixXd jacobian = derivatives(residuals, at, *now, options.difference);
    auto better = betterPoint(residuals, at, *now, jacobian, damping);
    if (!better) break;
    const double gained = 1 - better->second.squaredNorm() / now->squaredNorm();
    at = better->first;
    now = better->second;
    if (gained < options.enough) break;
  }
  return at;
}

}  // namespace fsr::discrepancy
