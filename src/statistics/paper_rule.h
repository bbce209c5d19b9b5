#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "statistics/samples.h"
#include "statistics/test_result.h"

namespace fsr::statistics {

/// Whose normality decides. The paper writes "normality of data"; what the t test needs is that of the
/// differences.
enum class NormalityOf { kEachTreatment, kDifferences };

struct PaperRuleOptions {
  double level = 0.05;
  NormalityOf normality = NormalityOf::kEachTreatment;
};

/// One step on the way: what was tested, and what followed from it.
struct Decision {
  std::string subject;     ///< "baseline", "method 1 - method 2", "all treatments"
  TestResult test;         ///< empty name where the step needed no test
  std::string conclusion;  ///< "normal", "not symmetric: paired sign test", ...
};

/// Two treatments (indices into RepeatedMeasures) against each other.
struct PairComparison {
  std::size_t first = 0;
  std::size_t second = 0;
  TestResult test;
  double adjusted_p = 0;  ///< Bonferroni over all pairs
  bool differ = false;    ///< adjusted_p < level
};

struct PaperRuleResult {
  std::vector<Decision> decisions;    ///< in the order they were taken
  TestResult test;                    ///< of all treatments together
  double p = 1;                       ///< its p, corrected for want of sphericity where that was found
  bool differ = false;                ///< p < level
  std::vector<PairComparison> pairs;  ///< of three or more treatments that differ: each pair
};

/// The paper's rule which test applies, and that test:
///
///   Shapiro-Wilk, every treatment normal?
///     yes, two:   paired t test
///     yes, more:  repeated-measures ANOVA, then paired t tests with Bonferroni
///     no, two:    differences symmetric? Wilcoxon signed-rank : paired sign test
///     no, more:   Friedman, then for each pair as for two, with Bonferroni
///
/// What it leaves open is decided so: symmetry by the triples test; Greenhouse-Geisser's p where
/// Mauchly's test rejects sphericity or cannot be had; pairs only where all together differ; every test
/// two-sided at `level`. A step that a test cannot take falls to the side that asks less of the data:
/// a treatment without scatter, or of more than 5000 units, is not normal, differences all the same
/// cannot go into a t test, fewer than five differences are not taken as symmetric.
///
/// To be printed under "as published, taxels treated as independent": they are not, and p values of
/// 70 taxels of one sheet say nothing about another sheet (see bootstrap.h).
///
/// InputError: fewer than 2 treatments or 3 units, lengths differ, a value not finite, level outside (0, 1).
PaperRuleResult paperRule(const RepeatedMeasures& measures, const PaperRuleOptions& options = {});

}  // namespace fsr::statistics
