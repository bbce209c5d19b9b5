#include "statistics/paired_sign_test.h"

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>

#include "statistics/samples.h"

namespace fsr::statistics {

TestResult pairedSignTest(const std::vector<double>& first, const std::vector<double>& second) {
  const std::vector<double> differences = pairedDifferences(first, second, "paired sign test");
  const auto positive = std::count_if(differences.begin(), differences.end(), [](double d) { return d > 0; });
  const auto zero = std::count(differences.begin(), differences.end(), 0.0);
  const auto signs = static_cast<std::ptrdiff_t>(differences.size()) - zero;

  TestResult result;
  result.test = "paired sign";
  result.symbol = "S";
  result.statistic = static_cast<double>(positive);
  result.n = differences.size();
  result.dropped = static_cast<std::size_t>(zero);
  result.p = 1;
  result.method = signs == 0 ? PMethod::kNothingToTest : PMethod::kExact;
  if (signs > 0) {
    const boost::math::binomial distribution(static_cast<double>(signs), 0.5);
    const auto fewer = static_cast<double>(std::min(positive, signs - positive));
    result.p = std::min(1.0, 2 * boost::math::cdf(distribution, fewer));
  }
  return result;
}

}  // namespace fsr::statistics
