#pragma once

#include <vector>

#include "statistics/test_result.h"

namespace fsr::statistics {

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

}  // namespace fsr::statistics
