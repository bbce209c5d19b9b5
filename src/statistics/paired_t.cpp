#include "statistics/paired_t.h"

#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <string>

#include "fsr_pressure_map/settings/input_error.h"
#include "statistics/samples.h"

namespace fsr::statistics {

namespace {

const char* const kPairedT = "paired t test";

TestResult emptyHanded(std::size_t n) {
  TestResult result;
  result.test = "paired t";
  result.symbol = "t";
  result.statistic = 0;
  result.degrees_of_freedom = {static_cast<double>(n - 1)};
  result.p = 1;
  result.n = n;
  result.method = PMethod::kNothingToTest;
  return result;
}

}  // namespace

PairedT pairedT(const std::vector<double>& first, const std::vector<double>& second) {
  const std::vector<double> differences = pairedDifferences(first, second, kPairedT);
  requireSample(differences, 2, kPairedT);
  const double n = static_cast<double>(differences.size());

  PairedT result;
  result.test = emptyHanded(differences.size());
  result.mean_difference = meanOf(differences);
  result.low = result.high = result.mean_difference;
  if (isConstant(differences)) {
    if (result.mean_difference == 0) return result;
    throw settings::InputError(std::string(kPairedT) + ": all differences are " +
                               std::to_string(result.mean_difference) +
                               "; it needs differences that are not all equal");
  }
  const double error = std::sqrt(squaredDeviations(differences) / (n - 1) / n);
  const boost::math::students_t distribution(n - 1);
  result.test.statistic = result.mean_difference / error;
  result.test.p = 2 * boost::math::cdf(distribution, -std::abs(result.test.statistic));
  result.test.method = PMethod::kParametric;
  const double reach = error * boost::math::quantile(distribution, 0.975);
  result.low -= reach;
  result.high += reach;
  return result;
}

}  // namespace fsr::statistics
