#pragma once

#include <limits>
#include <vector>

#include "statistics/paired_tests.h"
#include "statistics/samples.h"

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

/// The p of F with both degrees of freedom multiplied by epsilon.
struct SphericityCorrection {
  double epsilon = 1;
  double p = std::numeric_limits<double>::quiet_NaN();
};

struct RepeatedMeasuresAnova {
  TestResult test;     ///< F, uncorrected
  TestResult mauchly;  ///< W; p is NaN where it has no value (see below)
  SphericityCorrection greenhouse_geisser;
  SphericityCorrection huynh_feldt;  ///< epsilon as computed; p with min(epsilon, 1)
};

/// One-way analysis of variance within units: do the means of k treatments on the same n units differ?
///
///   F = (SS_treatments / (k-1)) / (SS_residual / ((k-1)(n-1))),  residual: x_ij - mean_i - mean_j + mean.
///
/// F has the F distribution where the differences of all pairs of treatments have the same variance
/// (sphericity). With
/// lambda the k-1 eigenvalues of the covariance of orthonormal contrasts between treatments:
///
/// - Mauchly:             W = prod lambda / mean(lambda)^(k-1), p by Box's two-term chi-squared series
/// - Greenhouse-Geisser:  epsilon = (sum lambda)^2 / ((k-1) sum lambda^2), from 1/(k-1) to 1
/// - Huynh-Feldt:         epsilon' = (n (k-1) epsilon - 2) / ((k-1) (n - 1 - (k-1) epsilon))
///
/// Sources: J. Mauchly, Ann. Math. Stat. 11 (1940) 204-209; T. Anderson, Introduction to Multivariate
/// Statistical Analysis, 1958, sec. 10.7; S. Greenhouse, S. Geisser, Psychometrika 24 (1959) 95-112;
/// H. Huynh, L. Feldt, J. Educational Statistics 1 (1976) 69-82.
///
/// F, the epsilons and their p values are those of R's anova(lm(x ~ 1), X = ~1, test = "Spherical") and of
/// SPSS (which prints min(epsilon', 1)). Mauchly's p differs from R's mauchly.test(lm(x ~ 1), X = ~1) by
/// about 1e-5, in the second term of the series: R uses k where the formula has the number of contrasts, k
/// - 1. Where R is given the contrasts, it agrees with this function (the tests show both lines).
///
/// Two treatments: F = t^2, sphericity holds: W = 1, epsilons 1, Mauchly p = 1.
/// n < k, or linearly dependent contrasts: W = 0, Mauchly p NaN; use the correction in any case.
/// Huynh-Feldt where its denominator is not positive (n = 2): epsilon' = 1.
/// No residual: p = 1, nothing to test, if the treatments do not differ either, else InputError.
/// InputError: fewer than 2 treatments or 2 units, lengths differ, a value not finite.
RepeatedMeasuresAnova repeatedMeasuresAnova(const RepeatedMeasures& measures);

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
