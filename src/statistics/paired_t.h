#pragma once

#include <vector>

#include "statistics/test_result.h"

namespace fsr::statistics {

struct PairedT {
  TestResult test;
  double mean_difference = 0;  ///< mean of first - second
  double low = 0;              ///< lower end of its 95 % interval
  double high = 0;             ///< upper end of it
};

/// Student's paired t test: do two treatments differ in the mean? For differences d = first - second that are
/// normal, or for many of them,
///
///   t = mean(d) / (deviation(d) / sqrt(n)),   n - 1 degrees of freedom.
///
/// Source: Student, Biometrika 6 (1908) 1-25. R's t.test(first, second, paired = TRUE) and
/// SPSS give the same result.
/// All differences zero: t = 0, p = 1, nothing to test (R stops).
/// InputError: fewer than 2 pairs, lengths differ, a value not finite, or all differences equal but not zero
/// (without scatter t has no value).
PairedT pairedT(const std::vector<double>& first, const std::vector<double>& second);

}  // namespace fsr::statistics
