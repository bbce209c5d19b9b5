#include "discrepancy/fit/penalised_spline.h"

#include <algorithm>
#include <cmath>

namespace fsr::discrepancy {

namespace {

// Each degree of freedom counts so often, which guards against too little smoothing (Kim and Gu 2004).
constexpr double kInflated = 1.4;
constexpr double kStep = 2;          // factor between the weights that are tried
constexpr double kForbidden = 1e6;   // weight of a slope that is too low, relative to the mean normal
constexpr double kTolerated = 1e-9;  // slope below the least
constexpr int kMostPenaltyRounds = 40;
constexpr int kReleases = 20;  // rounds in which a slope that was forbidden may rise again

}  // namespace

SplineSums::SplineSums(std::size_t knots)
    : normal_(
          Eigen::MatrixXd::Zero(2 * static_cast<Eigen::Index>(knots), 2 * static_cast<Eigen::Index>(knots))),
      right_(Eigen::VectorXd::Zero(2 * static_cast<Eigen::Index>(knots))) {}

void SplineSums::add(const simulation::SplineWeights& weights, double slope, double value) {
  const Eigen::Index knots = right_.size() / 2, k = static_cast<Eigen::Index>(weights.knot);
  const Eigen::Index at[] = {k, k + 1, knots + k, knots + k + 1};
  const double x[] = {slope * weights.below, slope * weights.above, slope * weights.below_bend,
                      slope * weights.above_bend};
  for (int a = 0; a < 4; ++a) {
    right_[at[a]] += x[a] * value;
    for (int b = 0; b < 4; ++b) normal_(at[a], at[b]) += x[a] * x[b];
  }
  square_ += value * value;
  ++number_;
}

Eigen::MatrixXd SplineSums::normal(const Eigen::MatrixXd& bends) const {
  const Eigen::Index n = right_.size() / 2;
  const Eigen::MatrixXd cross = normal_.topRightCorner(n, n) * bends;
  return normal_.topLeftCorner(n, n) + cross + cross.transpose() +
         bends.transpose() * normal_.bottomRightCorner(n, n) * bends;
}

Eigen::VectorXd SplineSums::right(const Eigen::MatrixXd& bends) const {
  const Eigen::Index n = right_.size() / 2;
  return right_.head(n) + bends.transpose() * right_.tail(n);
}

Eigen::MatrixXd secondDifferences(Eigen::Index knots) {
  Eigen::MatrixXd squares = Eigen::MatrixXd::Zero(knots, knots);
  for (Eigen::Index k = 1; k + 1 < knots; ++k) {
    const Eigen::Vector3d bend(1, -2, 1);
    squares.block<3, 3>(k - 1, k - 1) += bend * bend.transpose();
  }
  return squares;
}

PenalisedSpline::PenalisedSpline(Eigen::MatrixXd normal, Eigen::VectorXd right, double square, double number)
    : normal_(std::move(normal)), right_(std::move(right)), square_(square), number_(number) {
  const Eigen::MatrixXd rough = secondDifferences(normal_.rows());
  unit_ = std::max(normal_.diagonal().mean(), 1e-12);
  normal_ += kLeastWeight * unit_ * rough;
  normal_.diagonal().array() += 1e-12 * unit_;  // where fewer than two loads occur
  const Eigen::LLT<Eigen::MatrixXd> factor(normal_);
  const Eigen::MatrixXd half = factor.matrixL().solve(rough);
  const Eigen::MatrixXd both = factor.matrixL().solve(half.transpose());
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(0.5 * (both + both.transpose()));
  roughness_ = eigen.eigenvalues().cwiseMax(0);
  back_ = factor.matrixU().solve(eigen.eigenvectors());
}

PenalisedSpline::PenalisedSpline(const PenalisedSpline& like, Eigen::VectorXd right, double square,
                                 double number)
    : PenalisedSpline(like) {
  right_ = std::move(right);
  square_ = square;
  number_ = number;
}

Eigen::VectorXd PenalisedSpline::values(double weight) const {
  const Eigen::ArrayXd shrunk = 1 / (1 + penalty(weight) * roughness_.array());
  return back_ * (shrunk * (back_.transpose() * right_).array()).matrix();
}

double PenalisedSpline::crossValidated(double weight) const {
  const Eigen::ArrayXd shrunk = 1 / (1 + penalty(weight) * roughness_.array());
  const Eigen::ArrayXd own = 1 - kLeastWeight * unit_ * roughness_.array();  // of the data alone
  const Eigen::ArrayXd squared = (back_.transpose() * right_).array().square();
  const double error = square_ - 2 * (shrunk * squared).sum() + (shrunk.square() * squared * own).sum();
  const double freedom = number_ - kInflated * (shrunk * own).sum();
  if (freedom < 1) return INFINITY;
  return number_ * std::max(0.0, error) / (freedom * freedom);
}

// Forbidden slopes are drawn to the least slope by a large weight, until the set of them stays the same.
// Where the data draw such a slope upwards, it is set free again.
Eigen::VectorXd PenalisedSpline::valuesRising(double weight, const Eigen::MatrixXd& slopes,
                                              const Eigen::VectorXd& least) const {
  Eigen::VectorXd values = this->values(weight);
  const Eigen::MatrixXd plain = normal_ + penalty(weight) * secondDifferences(normal_.rows());
  std::vector<bool> active(static_cast<std::size_t>(least.size()), false);
  for (int round = 0; round < kMostPenaltyRounds; ++round) {
    const Eigen::VectorXd slope = slopes * values;
    bool changed = false;
    for (Eigen::Index k = 0; k < least.size(); ++k) {
      const bool now = active[static_cast<std::size_t>(k)];
      const bool release = now && round < kReleases && slope[k] > least[k];
      if (now ? !release : slope[k] >= least[k] - kTolerated) continue;
      active[static_cast<std::size_t>(k)] = !now;
      changed = true;
    }
    if (!changed) break;
    Eigen::MatrixXd normal = plain;
    Eigen::VectorXd right = right_;
    for (Eigen::Index k = 0; k < least.size(); ++k) {
      if (!active[static_cast<std::size_t>(k)]) continue;
      const double heavy = kForbidden * unit_ / std::max(1e-300, slopes.row(k).squaredNorm());
      normal += heavy * slopes.row(k).transpose() * slopes.row(k);
      right += heavy * least[k] * slopes.row(k).transpose();
    }
    values = normal.ldlt().solve(right);
  }
  return values;
}

double chooseWeight(const std::vector<PenalisedSpline>& splines) {
  double best = PenalisedSpline::kLeastWeight, least = INFINITY;
  for (double weight = PenalisedSpline::kLeastWeight; weight <= PenalisedSpline::kMostWeight;
       weight *= kStep) {
    double sum = 0;
    for (const PenalisedSpline& spline : splines)
      sum += spline.number() > 0 ? spline.crossValidated(weight) : 0;
    if (sum >= least) continue;
    least = sum;
    best = weight;
  }
  return best;
}

}  // namespace fsr::discrepancy
