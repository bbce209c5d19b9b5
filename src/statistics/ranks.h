#pragma once

#include <vector>

namespace fsr::statistics {

/// Ranks from 1; equal values share the mean of their ranks (R's rank(), ties.method = "average").
/// Values are equal if all their bits are, as in R. Values that should tie must not differ by rounding.
struct Ranking {
  std::vector<double> ranks;  ///< in the order of the values
  double tie_sum = 0;         ///< sum of t^3 - t over the groups of t equal values; 0 = no ties
};

/// Ranks of `values`, which must not contain NaN.
Ranking midranks(const std::vector<double>& values);

}  // namespace fsr::statistics
