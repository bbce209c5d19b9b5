#pragma once

#include <limits>

namespace fsr::statistics {

/// rSquared() and rmsePercent() of metrics.h for values that come one after another: number, range and
/// scatter of reference values. The digits are the same, and the memory does not grow with their number. Each
/// value is given to add(), and then, in the same order, to addAgain().
class ReferenceScatter {
 public:
  void add(double reference);
  void addAgain(double reference);

  double range() const { return high_ - low_; }  ///< largest - smallest

  /// rSquared() and rmsePercent() of predictions with this sum of squared errors, added in that order.
  double rSquared(double squared_errors) const;
  double rmsePercent(double squared_errors) const;

 private:
  double number_ = 0, sum_ = 0, squares_ = 0;
  double low_ = std::numeric_limits<double>::infinity(), high_ = -low_;
};

}  // namespace fsr::statistics
