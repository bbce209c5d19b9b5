#pragma once

#include "statistics/samples.h"
#include "statistics/test_result.h"

namespace fsr::statistics {

/// Friedman's test: do k treatments on the same n units differ? No distribution is assumed. The treatments
/// are ranked within each unit. With R_j the sum of ranks of treatment j,
///
///   chi2 = 12 sum_j (R_j - n (k + 1) / 2)^2 / (n k (k + 1) - sum(t^3 - t) / (k - 1)),
///
/// where the last sum is over groups of t equal values within a unit. It has k - 1 degrees of freedom.
/// Source: M. Friedman, J. Am. Stat. Assoc. 32 (1937) 675-701; ties as in M. Hollander, D. Wolfe,
/// Nonparametric Statistical Methods, 1999, eq. 7.8. R's friedman.test and SPSS give the same result.
///
/// p is the chi-squared approximation, which is rough below about ten units. With two treatments the test is
/// an approximation of the sign test. The largest possible chi2 is n (k - 1): 140 for three and 280 for five
/// treatments on 70 taxels. Ahmadizadeh and Menon 2019 (doi:10.3390/s19245519) report 107 to 110 and 247 to
/// 270.
///
/// Where every unit ranks all treatments equal: chi2 = 0, p = 1, nothing to test (R returns NaN).
/// InputError: fewer than 2 treatments or 2 units, lengths differ, a value not finite.
TestResult friedman(const RepeatedMeasures& measures);

}  // namespace fsr::statistics
