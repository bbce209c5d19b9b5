#pragma once

#include <limits>

#include "statistics/samples.h"
#include "statistics/test_result.h"

namespace fsr::statistics {

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

}  // namespace fsr::statistics
