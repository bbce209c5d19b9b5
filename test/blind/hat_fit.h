#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <utility>

#include "blind/campaign.h"

namespace blind {

/// An independent static fit for the tests: for each taxel and surface least squares with hat functions every
/// 20 kPa of `pressure`, which has a value for each scan of the campaign.
class HatFit {
 public:
  HatFit(const Campaign& campaign, Trace pressure) : campaign_(campaign), pressure_(std::move(pressure)) {
    const auto [lowest, highest] = std::minmax_element(pressure_.begin(), pressure_.end());
    lowest_ = *lowest;
    knots_ = static_cast<Eigen::Index>((*highest - lowest_) / kStep) + 2;
  }

  Trace residual(const Trace& reading) const {
    Trace residual = reading;
    for (std::size_t surface = 0; surface < campaign_.surfaces.size(); ++surface) {
      Eigen::MatrixXd normal = 1e-9 * Eigen::MatrixXd::Identity(knots_, knots_);
      Eigen::VectorXd right = Eigen::VectorXd::Zero(knots_);
      eachScan(surface, [&](std::size_t scan, Eigen::Index knot, double share) {
        const double low = 1 - share;
        normal(knot, knot) += low * low;
        normal(knot, knot + 1) += low * share;
        normal(knot + 1, knot) += low * share;
        normal(knot + 1, knot + 1) += share * share;
        right(knot) += low * reading[scan];
        right(knot + 1) += share * reading[scan];
      });
      const Eigen::VectorXd curve = normal.ldlt().solve(right);
      eachScan(surface, [&](std::size_t scan, Eigen::Index knot, double share) {
        residual[scan] -= (1 - share) * curve(knot) + share * curve(knot + 1);
      });
    }
    return residual;
  }

 private:
  static constexpr double kStep = 20e3;  // [Pa]
  template <typename Use>
  void eachScan(std::size_t surface, Use use) const {
    for (const Visit& visit : campaign_.visits) {
      if (visit.surface != surface) continue;
      for (std::size_t scan = visit.first; scan < visit.last; ++scan) {
        const double place = (pressure_[scan] - lowest_) / kStep;
        const auto knot = static_cast<Eigen::Index>(place);
        use(scan, knot, place - static_cast<double>(knot));
      }
    }
  }
  const Campaign& campaign_;
  Trace pressure_;
  double lowest_ = 0;
  Eigen::Index knots_ = 0;
};

inline double meanSquare(const Trace& trace) {
  double squares = 0;
  for (const double value : trace) squares += value * value;
  return squares / static_cast<double>(trace.size());
}

inline Trace minus(Trace a, const Trace& b) {
  for (std::size_t i = 0; i < a.size(); ++i) a[i] -= b[i];
  return a;
}

}  // namespace blind
