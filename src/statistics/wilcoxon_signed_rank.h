#pragma once

#include <cstddef>
#include <vector>

#include "statistics/test_result.h"

namespace fsr::statistics {

enum class WilcoxonMethod {
  kAuto,    ///< exact below kWilcoxonExactBelow differences, else normal
  kExact,   ///< any number of differences; time and memory grow as n^3 and n^2
  kNormal,  ///< normal approximation with continuity correction
};

/// R's limit between exact and approximate.
constexpr std::size_t kWilcoxonExactBelow = 50;

/// Wilcoxon's signed-rank test: are the differences symmetric about zero? Differences of zero are
/// dropped, the magnitudes of the rest ranked (equal ones share their mean rank);
///
///   V = sum of the ranks of the positive differences.
///
/// Exact: each of the 2^n ways to give the ranks their signs is as likely as the next, so the
/// distribution of V given the ranks is counted. Without ties it is the tabled one, as R's
/// wilcox.test(paired = TRUE) below 50 differences. With ties or zeros it is the conditional
/// (permutation) distribution, as R's exactRankTests::wilcox.exact and coin::wilcoxsign_test; base R
/// falls back to the approximation there, with a warning, however few the values are.
/// Normal: mean n(n+1)/4, variance n(n+1)(2n+1)/24 - sum(t^3 - t)/48 over groups of t ties, and a
/// continuity correction of 1/2, as R; SPSS leaves the correction out.
/// Sources: F. Wilcoxon, Biometrics Bulletin 1 (1945) 80-83; E. Lehmann, Nonparametrics, 1975, ch. 3.
///
/// It asks for symmetry (see triples_test.h); where that fails it answers a question nobody put.
/// All differences zero: V = 0, p = 1, nothing to test.
/// InputError: no pair, lengths differ, a value not finite, kExact on more than 1000 differences.
TestResult wilcoxonSignedRank(const std::vector<double>& first, const std::vector<double>& second,
                              WilcoxonMethod method = WilcoxonMethod::kAuto);

}  // namespace fsr::statistics
