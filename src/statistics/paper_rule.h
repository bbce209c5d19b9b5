#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "statistics/paired_tests.h"
#include "statistics/samples.h"

namespace fsr::statistics {

// Corrections for m tests on the same data. The adjusted p value is compared with the level (0.05) of the
// whole family of tests. They are valid for any dependence between the tests. The adjusted values are in the
// order of the given ones. An empty list gives an empty list. InputError: a p value that is NaN or outside
// [0, 1].

/// min(1, m p), the correction that the paper uses. Source: O. Dunn, J. Am. Stat. Assoc. 56 (1961) 52-64.
/// R's p.adjust(p, "bonferroni") and SPSS give the same result.
std::vector<double> bonferroni(const std::vector<double>& p);

/// The data whose normality decides. Ahmadizadeh and Menon 2019 (doi:10.3390/s19245519), "the paper", write
/// "normality of data"; the t test needs normal differences.
enum class NormalityOf { kEachTreatment, kDifferences };

struct PaperRuleOptions {
  double level = 0.05;
  NormalityOf normality = NormalityOf::kEachTreatment;
};

/// One step of the rule: what was tested and what followed.
struct Decision {
  std::string subject;     ///< "baseline", "method 1 - method 2", "all treatments"
  TestResult test;         ///< empty name where the step needed no test
  std::string conclusion;  ///< "normal", "not symmetric: paired sign test", ...
};

/// Comparison of two treatments (indices into RepeatedMeasures).
struct PairComparison {
  std::size_t first = 0;
  std::size_t second = 0;
  TestResult test;
  double adjusted_p = 0;  ///< Bonferroni over all pairs
  bool differ = false;    ///< adjusted_p < level
};

struct PaperRuleResult {
  std::vector<Decision> decisions;    ///< in order
  TestResult test;                    ///< of all treatments together
  double p = 1;                       ///< p of that test, corrected where sphericity is violated
  bool differ = false;                ///< p < level
  std::vector<PairComparison> pairs;  ///< all pairs of three or more treatments that differ
};

/// The paper's rule for choosing a test, and the result of that test:
///
///   Shapiro-Wilk, every treatment normal?
///     yes, two:   paired t test
///     yes, more:  repeated-measures ANOVA, then paired t tests with Bonferroni
///     no, two:    differences symmetric? Wilcoxon signed-rank : paired sign test
///     no, more:   Friedman, then for each pair as for two, with Bonferroni
///
/// The paper leaves some choices open. Here symmetry is judged by the triples test. Greenhouse-Geisser's p is
/// used where Mauchly's test rejects sphericity or has no result. Pairs are compared only where all
/// treatments together differ. Every test is two-sided at `level`. Where a test cannot be applied, the step
/// that assumes less is taken: a treatment without scatter, or with more than 5000 units, is not normal;
/// differences that are all equal do not enter a t test; fewer than five differences are not symmetric.
///
/// Reports print the result under "as published, taxels treated as independent". They are not independent,
/// and p values of 70 taxels of one sheet say nothing about another sheet (see bootstrap.h).
///
/// InputError: fewer than 2 treatments or 3 units, lengths differ, a value not finite, level outside (0, 1).
PaperRuleResult paperRule(const RepeatedMeasures& measures, const PaperRuleOptions& options = {});

}  // namespace fsr::statistics
