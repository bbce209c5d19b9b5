#include "statistics/friedman.h"

#include <boost/math/distributions/chi_squared.hpp>

#include "statistics/ranks.h"

namespace fsr::statistics {

namespace {

struct RankSums {
  std::vector<double> of_treatment;
  double ties = 0;
};

RankSums rankWithinUnits(const RepeatedMeasures& measures) {
  RankSums sums;
  sums.of_treatment.resize(measures.values.size());
  std::vector<double> row(measures.values.size());
  for (std::size_t unit = 0; unit < measures.units(); ++unit) {
    for (std::size_t j = 0; j < row.size(); ++j) row[j] = measures.values[j][unit];
    const Ranking ranking = midranks(row);
    for (std::size_t j = 0; j < row.size(); ++j) sums.of_treatment[j] += ranking.ranks[j];
    sums.ties += ranking.tie_sum;
  }
  return sums;
}

}  // namespace

TestResult friedman(const RepeatedMeasures& measures) {
  requireMeasures(measures, 2, 2, "Friedman test");
  const RankSums sums = rankWithinUnits(measures);
  const double n = static_cast<double>(measures.units()), k = static_cast<double>(measures.values.size());
  double square = 0;
  for (const double sum : sums.of_treatment) square += (sum - n * (k + 1) / 2) * (sum - n * (k + 1) / 2);
  const double scale = n * k * (k + 1) - sums.ties / (k - 1);

  TestResult result;
  result.test = "Friedman";
  result.symbol = "chi2";
  result.degrees_of_freedom = {k - 1};
  result.n = measures.units();
  // All terms are multiples of one half, so the comparison with zero is exact.
  result.statistic = scale == 0 ? 0 : 12 * square / scale;
  result.p = boost::math::cdf(boost::math::complement(boost::math::chi_squared(k - 1), result.statistic));
  result.method = scale == 0 ? PMethod::kNothingToTest : PMethod::kChiSquaredApproximation;
  return result;
}

}  // namespace fsr::statistics
