#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

namespace fsr::statistics {

/// How a p value was computed.
enum class PMethod {
  kExact,                    ///< all outcomes were counted
  kParametric,               ///< the statistic's distribution for normal data (t, F)
  kNormalApproximation,      ///< holds for many units
  kChiSquaredApproximation,  ///< holds for many units
  kNothingToTest,            ///< the data do not vary: p = 1 by definition
};

/// "exact", "parametric", "normal approximation", "chi-squared approximation", "nothing to test".
std::string pMethodName(PMethod method);

/// Result of a test. All p values are two-sided and assume independent units. Taxels of one sheet are not
/// independent (see bootstrap.h).
struct TestResult {
  std::string test;    ///< "Wilcoxon signed-rank"
  std::string symbol;  ///< of the statistic, as papers print it: "W", "t", "F", "chi2", "V", ...
  double statistic = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> degrees_of_freedom;  ///< none, one (t, chi2) or two (F)
  double p = std::numeric_limits<double>::quiet_NaN();
  std::size_t n = 0;        ///< number of units
  std::size_t dropped = 0;  ///< units without information (differences of zero)
  PMethod method = PMethod::kExact;
};

/// Ranks from 1; equal values share the mean of their ranks (R's rank(), ties.method = "average").
/// Values are equal if all their bits are, as in R. Values that should tie must not differ by rounding.
struct Ranking {
  std::vector<double> ranks;  ///< in the order of the values
  double tie_sum = 0;         ///< sum of t^3 - t over the groups of t equal values; 0 = no ties
};

/// Ranks of `values`, which must not contain NaN.
Ranking midranks(const std::vector<double>& values);

/// Paired-samples sign test: is the median difference zero? It assumes no distribution, not even symmetry,
/// and uses only the signs of the differences.
///
/// Of the m differences that are not zero, S are positive. Under the null hypothesis S is binomial(m, 1/2),
/// and p = min(1, 2 P(X <= min(S, m - S))). It is always exact, like R's binom.test(S, m). SPSS is exact up
/// to 25 pairs and uses the normal approximation with continuity correction above. Source: W. Dixon, A. Mood,
/// J. Am. Stat. Assoc. 41 (1946) 557-566.
///
/// All differences zero: S = 0, p = 1, nothing to test.
/// InputError: no pair, lengths differ, a value not finite.
TestResult pairedSignTest(const std::vector<double>& first, const std::vector<double>& second);

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

enum class WilcoxonMethod {
  kAuto,    ///< exact below kWilcoxonExactBelow differences, else normal
  kExact,   ///< any number of differences; time grows as n^3, memory as n^2
  kNormal,  ///< normal approximation with continuity correction
};

/// R uses the exact distribution below this number of differences.
constexpr std::size_t kWilcoxonExactBelow = 50;

/// Wilcoxon's signed-rank test: are the differences symmetric about zero? Differences of zero are dropped.
/// The magnitudes of the others are ranked (equal ones share their mean rank);
///
///   V = sum of the ranks of the positive differences.
///
/// Exact: all 2^n assignments of signs to the ranks are equally likely, so the distribution of V given the
/// ranks is counted. Without ties it is the tabulated one, as in R's wilcox.test(paired = TRUE) below 50
/// differences. With ties or zeros it is the conditional (permutation) distribution, as in R's
/// exactRankTests::wilcox.exact and coin::wilcoxsign_test. Base R then uses the approximation, with a
/// warning, for any number of values. Normal: mean n(n+1)/4, variance n(n+1)(2n+1)/24 - sum(t^3 - t)/48 over
/// groups of t ties, and a continuity correction of 1/2, as in R. SPSS does not use the correction. Sources:
/// F. Wilcoxon, Biometrics Bulletin 1 (1945) 80-83; E. Lehmann, Nonparametrics, 1975, ch. 3.
///
/// The differences must be symmetric (see triples_test.h). Otherwise the test does not compare medians.
/// All differences zero: V = 0, p = 1, nothing to test.
/// InputError: no pair, lengths differ, a value not finite, kExact on more than 1000 differences.
TestResult wilcoxonSignedRank(const std::vector<double>& first, const std::vector<double>& second,
                              WilcoxonMethod method = WilcoxonMethod::kAuto);

/// Triples test: is a distribution symmetric about any centre? The paper chooses by symmetry between
/// Wilcoxon's test, which needs symmetric differences, and the sign test, which does not. It does not say how
/// symmetry was tested; SPSS has no such test.
///
/// A triple of values is skewed to the right where the middle one is closer to the smallest, to the left
/// where it is closer to the largest. T = right triples - left triples, and z = T / sigma is standard normal
/// for large n, with
///
///   sigma^2 = (n-3)(n-4) / ((n-1)(n-2)) sum_i B_i^2 + (n-3) / (n-4) sum_{i<j} B_ij^2
///             + n(n-1)(n-2) / 6 - (1 - (n-3)(n-4)(n-5) / (n(n-1)(n-2))) T^2,
///
/// B_i and B_ij the sums over the triples that contain i, or i and j.
/// Source: R. Randles, M. Fligner, G. Policello, D. Wolfe, J. Am. Stat. Assoc. 75 (1980) 168-172;
/// M. Hollander, D. Wolfe, Nonparametric Statistical Methods, 1999, sec. 3.9.
///
/// It is used instead of tests of (mean - median) / deviation, e.g. that of Miao, Gel and Gastwirth (2006).
/// Their critical values hold for normal data, but symmetry is tested here only where normality was rejected.
/// At a level of 5 % and 70 values (10,000 trials each) the triples test rejects 6.8 % of uniform, 5.4 % of
/// normal, 6.1 % of Laplace's and 6.2 % of Student's samples with 2 degrees of freedom; the other test
/// rejects 9.4, 4.6, 6.0 and 22 %. With fewer than 20 values the triples test has little power. Its time is
/// proportional to n^2 log n.
///
/// All values equal: T = 0, p = 1, nothing to test. A triple whose middle value is exactly in the middle,
/// e.g. because of ties, counts for neither side. InputError: fewer than 5 values (sigma has no value), one
/// not finite.
TestResult triplesTest(const std::vector<double>& sample);

}  // namespace fsr::statistics
