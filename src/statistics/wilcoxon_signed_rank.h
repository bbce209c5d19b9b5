#pragma once

#include <cstddef>
#include <vector>

#include "statistics/test_result.h"

namespace fsr::statistics {

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

}  // namespace fsr::statistics
