#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

namespace fsr::statistics {

/// Where a p value comes from.
enum class PMethod {
  kExact,                    ///< every outcome counted
  kParametric,               ///< the statistic's own distribution where the data are normal (t, F)
  kNormalApproximation,      ///< holds for many units
  kChiSquaredApproximation,  ///< holds for many units
  kNothingToTest,            ///< the data do not vary: p = 1 by definition
};

/// "exact", "parametric", "normal approximation", "chi-squared approximation", "nothing to test".
std::string pMethodName(PMethod method);

/// What every test of this room answers. All p values are two-sided. A p is worth no more than the
/// independence of its units: taxels of one sheet are not independent (see bootstrap.h).
struct TestResult {
  std::string test;    ///< "Wilcoxon signed-rank"
  std::string symbol;  ///< of the statistic, as papers print it: "W", "t", "F", "chi2", "V", ...
  double statistic = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> degrees_of_freedom;  ///< none, one (t, chi2) or two (F)
  double p = std::numeric_limits<double>::quiet_NaN();
  std::size_t n = 0;        ///< units given
  std::size_t dropped = 0;  ///< units of these that carry nothing (differences of zero)
  PMethod method = PMethod::kExact;
};

}  // namespace fsr::statistics
