#include "statistics/reference_scatter.h"

#include <algorithm>
#include <cmath>

namespace fsr::statistics {

namespace {

constexpr double kNoFigure = std::numeric_limits<double>::quiet_NaN();

}  // namespace

void ReferenceScatter::add(double reference) {
  number_ += 1;
  sum_ += reference;
  low_ = std::min(low_, reference);
  high_ = std::max(high_, reference);
}

void ReferenceScatter::addAgain(double reference) {
  const double mean = sum_ / number_;
  squares_ += (reference - mean) * (reference - mean);
}

double ReferenceScatter::rSquared(double squared_errors) const {
  return number_ >= 2 && squares_ > 0 ? 1.0 - squared_errors / squares_ : kNoFigure;
}

double ReferenceScatter::rmsePercent(double squared_errors) const {
  return range() > 0 ? 100.0 * std::sqrt(squared_errors / number_) / range() : kNoFigure;
}

}  // namespace fsr::statistics
