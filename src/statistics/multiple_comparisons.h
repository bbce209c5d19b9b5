#pragma once

#include <vector>

namespace fsr::statistics {

// Corrections for m tests asked of the same data: the adjusted p value is compared with the level
// (0.05) that the whole family may err with. Both hold whatever the dependence between the tests.
// The adjusted values come in the order of the given ones. An empty list gives an empty list.
// InputError: a p value that is NaN or outside [0, 1].

/// min(1, m p), the paper's. Source: O. Dunn, J. Am. Stat. Assoc. 56 (1961) 52-64.
/// As R's p.adjust(p, "bonferroni") and SPSS.
std::vector<double> bonferroni(const std::vector<double>& p);

/// The i-th smallest p times m + 1 - i, made monotone, at most 1: never larger than Bonferroni's, and
/// as safe; what one would use today. Source: S. Holm, Scand. J. Statistics 6 (1979) 65-70.
/// As R's p.adjust(p, "holm").
std::vector<double> holm(const std::vector<double>& p);

/// The i-th smallest p times m (1 + 1/2 + ... + 1/m) / i, made monotone, at most 1: bounds the share of false
/// ones among what is found. Source: Y. Benjamini, D. Yekutieli, Ann. Statistics 29 (2001) 1165-1188.
/// As R's p.adjust(p, "BY").
std::vector<double> benjaminiYekutieli(const std::vector<double>& p);

}  // namespace fsr::statistics
