#pragma once

#include "statistics/samples.h"
#include "statistics/test_result.h"

namespace fsr::statistics {

/// Friedman's test: do k treatments on the same n units differ, whatever the distribution? Each unit
/// ranks its own treatments; with R_j the sum of ranks of treatment j,
///
///   chi2 = 12 sum_j (R_j - n (k + 1) / 2)^2 / (n k (k + 1) - sum(t^3 - t) / (k - 1)),
///
/// the last sum over groups of t equal values within a unit; k - 1 degrees of freedom.
/// Source: M. Friedman, J. Am. Stat. Assoc. 32 (1937) 675-701; ties as in M. Hollander, D. Wolfe,
/// Nonparametric Statistical Methods, 1999, eq. 7.8. As R's friedman.test and SPSS.
///
/// p is the chi-squared approximation, rough below some ten units. With two treatments it is the sign
/// test, less exactly. Its largest value is n (k - 1): 140 for three and 280 for five treatments on
/// 70 taxels, against which the paper's 107 to 110 and 247 to 270 are to be read.
///
/// Every unit ranks all its treatments equal: chi2 = 0, p = 1, nothing to test (R answers NaN).
/// InputError: fewer than 2 treatments or 2 units, lengths differ, a value not finite.
TestResult friedman(const RepeatedMeasures& measures);

}  // namespace fsr::statistics
