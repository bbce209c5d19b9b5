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

}  // namespace fsr::statistics
