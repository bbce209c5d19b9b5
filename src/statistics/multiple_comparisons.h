#pragma once

#include <vector>

namespace fsr::statistics {

// Corrections for m tests on the same data. The adjusted p value is compared with the level (0.05) of the
// whole family of tests. They are valid for any dependence between the tests. The adjusted values are in the
// order of the given ones. An empty list gives an empty list. InputError: a p value that is NaN or outside
// [0, 1].

/// min(1, m p), the correction that the paper uses. Source: O. Dunn, J. Am. Stat. Assoc. 56 (1961) 52-64.
/// R's p.adjust(p, "bonferroni") and SPSS give the same result.
std::vector<double> bonferroni(const std::vector<double>& p);

}  // namespace fsr::statistics
