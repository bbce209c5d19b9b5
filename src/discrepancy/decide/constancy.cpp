#include "discrepancy/decide/constancy.h"

#include <algorithm>
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

// The sizes that the cycles want.
class Sizes {
 public:
  Sizes(const Measured& measured, const Trace& part, const Trace& wanted);

  Eigen::Index number() const { return size_.size(); }
  const Eigen::ArrayXd& pace() const { return pace_; }
  const Eigen::ArrayXd& time() const { return time_; }
  // Variance of a variable over the cycles.
  double variance(const Eigen::ArrayXd& over) const { return (weight_ * centred(over).square()).sum(); }
  // Whether the sizes change over a variable: by more than `permitted` of their mean in each unit of it, and
  // beyond the interval.
  bool change(const Eigen::ArrayXd& over, double permitted) const;

 private:
  Eigen::ArrayXd centred(const Eigen::ArrayXd& over) const { return over - (weight_ * over).sum(); }

  Eigen::ArrayXd weight_;  // of each cycle, with the sum 1
  Eigen::ArrayXd size_;
  Eigen::ArrayXd pace_;  // ln v
  Eigen::ArrayXd time_;  // of its beginning, 0 = the first one, 1 = the last one
};

Sizes::Sizes(const Measured& measured, const Trace& part, const Trace& wanted) {
  const auto most = static_cast<Eigen::Index>(measured.cycles.size());
  for (Eigen::ArrayXd* one : {&weight_, &size_, &pace_, &time_}) one->resize(most);
  Eigen::Index n = 0;
  for (const MeasuredCycle& cycle : measured.cycles) {
    const auto first = static_cast<Eigen::Index>(cycle.first);
    const auto own = part.segment(first, static_cast<Eigen::Index>(cycle.last) - first);
    const double v = paceOf(measured, cycle);
    if (cycle.use != CycleUse::kFit || own.isZero(0) || !(v > 0)) continue;
    weight_[n] = own.squaredNorm();
    pace_[n] = std::log(v);
    time_[n] = measured.time[cycle.first];
    size_[n++] = own.dot(wanted.segment(first, own.size())) / own.squaredNorm();
  }
  for (Eigen::ArrayXd* one : {&weight_, &size_, &pace_, &time_}) one->conservativeResize(n);
  if (n < 2) return;
  weight_ /= weight_.sum();
  time_ = (time_ - time_.minCoeff()) / (time_.maxCoeff() - time_.minCoeff());
}

bool Sizes::change(const Eigen::ArrayXd& over, double permitted) const {
  constexpr double kTwoSided = 0.975;
  const Eigen::ArrayXd x = centred(over);
  const double mean = (weight_ * size_).sum(), of_x = variance(over);
  const double slope = (weight_ * x * size_).sum() / of_x;
  const double of_slope = (weight_ * x * (size_ - mean - slope * x) / of_x).square().sum();
  const boost::math::students_t t(static_cast<double>(number()) - 2);
  const double half_interval = boost::math::quantile(t, kTwoSided) * std::sqrt(of_slope);
  return std::abs(slope) > std::max(half_interval, permitted * std::abs(mean));
}

}  // namespace

bool isConstant(const Measured& measured, const Trace& part, const Trace& wanted) {
  constexpr double kHalfway = 0.5, kOnce = 1;
  constexpr double kTwoPaces = 1.5;  // their ratio
  const Sizes sizes(measured, part, wanted);
  if (sizes.number() < 3) return true;
  const bool two_paces = sizes.variance(sizes.pace()) > std::pow(std::log(kTwoPaces) / 2, 2);
  return !(two_paces && sizes.change(sizes.pace(), kHalfway)) && !sizes.change(sizes.time(), kOnce);
}

}  // namespace fsr::discrepancy
