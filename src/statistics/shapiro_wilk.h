#pragma once

#include <vector>

#include "statistics/test_result.h"

namespace fsr::statistics {

/// Shapiro-Wilk test: is a sample from a normal distribution? The paper applies it before every other test.
///
///   W = (sum_i a_i x_(i))^2 / sum_i (x_i - mean)^2,   x_(1) <= ... <= x_(n)
///
/// with a the normalised expected order statistics of a normal sample; W = 1 is a straight line in the
/// normal probability plot. a and the distribution of ln(1 - W) are Royston's polynomials in n, for 3 to 5000
/// values; for n = 3 the distribution is exact.
/// Source: P. Royston, Algorithm AS R94, Applied Statistics 44 (1995) 547-551. R's shapiro.test,
/// SciPy's shapiro and SPSS follow the same paper.
///
/// With about 50 values or more it rejects deviations from normality that do not affect a t test. With ten it
/// rejects only large ones. It is used here to choose a test because the paper did so; this is no good reason
/// in itself. Many equal values (a coarse converter) make W small.
///
/// InputError: fewer than 3 or more than 5000 values, one not finite, all equal.
TestResult shapiroWilk(const std::vector<double>& sample);

}  // namespace fsr::statistics
