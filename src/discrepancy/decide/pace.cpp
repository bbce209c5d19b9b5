#include "discrepancy/decide/pace.h"

#include <boost/math/distributions/students_t.hpp>
#include <cmath>

namespace fsr::discrepancy {

namespace {

// Mean rate of a cycle, weighted by the path of the pressure [Pa/s].
double paceOf(const Measured& measured, const MeasuredCycle& cycle) {
  double squares = 0, sum = 0;
  for (std::size_t i = cycle.first; i < cycle.last; ++i) {
    squares += measured.rate[i] * measured.rate[i];
    sum += std::abs(measured.rate[i]);
  }
  return sum > 0 ? squares / sum : 0;
}

}  // namespace

bool isSameAtEachPace(const Measured& measured, const Trace& part, const Trace& wanted) {
  constexpr double kMiddle = 0.5, kTwoSided = 0.975;
  constexpr double kTwoPaces = 1.5;  // their ratio
  const auto most = static_cast<Eigen::Index>(measured.cycles.size());
  Eigen::ArrayXd weight(most), pace(most), size(most);
  Eigen::Index n = 0;
  for (const MeasuredCycle& cycle : measured.cycles) {
    const auto first = static_cast<Eigen::Index>(cycle.first);
    const auto own = part.segment(first, static_cast<Eigen::Index>(cycle.last) - first);
    const double v = paceOf(measured, cycle);
    if (cycle.use != CycleUse::kFit || own.isZero(0) || !(v > 0)) continue;
    weight[n] = own.squaredNorm();
    pace[n] = std::log(v);
    size[n++] = own.dot(wanted.segment(first, own.size())) / own.squaredNorm();
  }
  for (Eigen::ArrayXd* one : {&weight, &pace, &size}) one->conservativeResize(n);
  if (n < 3) return true;
  const double mean = (weight * size).sum() / weight.sum();
  pace -= (weight * pace).sum() / weight.sum();
  const double spread = (weight * pace.square()).sum();
  if (!(spread > weight.sum() * std::pow(std::log(kTwoPaces) / 2, 2))) return true;
  const double slope = (weight * pace * size).sum() / spread;
  const double variance = (weight * pace * (size - mean - slope * pace) / spread).square().sum();
  const boost::math::students_t t(static_cast<double>(n) - 2);
  const double half_interval = boost::math::quantile(t, kTwoSided) * std::sqrt(variance);
  return std::abs(slope) <= std::max(half_interval, kMiddle * std::abs(mean));
}

}  // namespace fsr::discrepancy
