#pragma once

#include <limits>
#include <vector>

namespace fsr::statistics {

/// Standard deviation of normally distributed numbers of mean 0 / median of their absolute values.
constexpr double kDeviationPerMedian = 1.4826;

/// Upper median: element n / 2 (counted from 0) of the n sorted values. For an even number of values this is
/// the larger of the two in the middle, so the result is always one of the values. `of_none`: the result
/// where there are no values. No value may be NaN.
double upperMedian(std::vector<double> values, double of_none = std::numeric_limits<double>::quiet_NaN());

}  // namespace fsr::statistics
