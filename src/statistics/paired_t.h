#pragma once

#include <vector>

#include "statistics/test_result.h"

namespace fsr::statistics {

struct PairedT {
  TestResult test;
  double mean_difference = 0;  ///< mean of first - second
  double low = 0;              ///< 95 % interval of it
  double high = 0;
};

/// Student's paired t test: do two treatments differ in the mean? For differences d = first - second
/// that are normal (or many),
///
///   t = mean(d) / (deviation(d) / sqrt(n)),   n - 1 degrees of freedom.
///
/// Source: Student, Biometrika 6 (1908) 1-25. As R's t.test(first, second, paired = TRUE) and SPSS.
/// All differences zero: t = 0, p = 1, nothing to test (R stops).
/// InputError: fewer than 2 pairs, lengths differ, a value not finite, the differences all the same but
/// not zero (t has no value: no scatter to hold the difference against).
PairedT pairedT(const std::vector<double>& first, const std::vector<double>& second);

}  // namespace fsr::statistics
