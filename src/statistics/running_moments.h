#pragma once

#include <cmath>

namespace fsr::statistics {

/// Mean and scatter of values that come one after another (B. P. Welford, Technometrics 4, 1962).
struct RunningMoments {
  double count = 0, mean = 0;
  double squares = 0;  ///< sum of squared differences from the mean

  void add(double value) {
    const double step = value - mean;
    count += 1;
    mean += step / count;
    squares += step * (value - mean);
  }

  /// As if the values of `other` had been added (T. F. Chan, G. H. Golub, R. J. LeVeque, COMPSTAT 1982).
  void merge(const RunningMoments& other) {
    if (other.count == 0) return;
    const double step = other.mean - mean, share = other.count / (count + other.count);
    squares += other.squares + step * step * count * share;
    mean += step * share;
    count += other.count;
  }

  /// With the divisor n - 1; 0 for fewer than two values.
  double deviation() const { return count > 1 ? std::sqrt(squares / (count - 1)) : 0.0; }
};

}  // namespace fsr::statistics
