#include "statistics/triples_test.h"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <limits>

#include "statistics/samples.h"

namespace fsr::statistics {

namespace {

using Iterator = std::vector<double>::const_iterator;

double countAbove(Iterator begin, Iterator end, double limit) {
  return static_cast<double>(end - std::upper_bound(begin, end, limit));
}

double countBelow(Iterator begin, Iterator end, double limit) {
  return static_cast<double>(std::lower_bound(begin, end, limit) - begin);
}

/// B_ij of two values x_i <= x_j of the sorted sample. A third value between them gives a right triple where
/// it is below their middle. A third value above them gives a right triple where its distance to x_j is
/// larger than x_j - x_i; one below them, where its distance to x_i is smaller than that.
double leaningOfPair(const std::vector<double>& sorted, std::size_t i, std::size_t j) {
  const Iterator x = sorted.begin(), end = sorted.end();
  const double middle = 0.5 * (sorted[i] + sorted[j]);
  const double above = 2 * sorted[j] - sorted[i], below = 2 * sorted[i] - sorted[j];
  return countBelow(x + i + 1, x + j, middle) - countAbove(x + i + 1, x + j, middle) +
         countAbove(x + j + 1, end, above) - countBelow(x + j + 1, end, above) + countAbove(x, x + i, below) -
         countBelow(x, x + i, below);
}

struct Leaning {
  double total = 0;      // T
  double of_values = 0;  // sum of B_i^2
  double of_pairs = 0;   // sum of B_ij^2
};

Leaning leaningOf(const std::vector<double>& sorted) {
  Leaning sums;
  std::vector<double> of_value(sorted.size());
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    for (std::size_t j = i + 1; j < sorted.size(); ++j) {
      const double pair = leaningOfPair(sorted, i, j);
      sums.of_pairs += pair * pair;
      sums.total += pair / 3;  // every triple has three pairs
      of_value[i] += pair / 2;
      of_value[j] += pair / 2;
    }
  }
  for (const double value : of_value) sums.of_values += value * value;
  sums.total = std::round(sums.total);
  return sums;
}

double varianceOf(const Leaning& sums, double n) {
  const double triples = n * (n - 1) * (n - 2);
  return (n - 3) * (n - 4) / ((n - 1) * (n - 2)) * sums.of_values + (n - 3) / (n - 4) * sums.of_pairs +
         triples / 6 - (1 - (n - 3) * (n - 4) * (n - 5) / triples) * sums.total * sums.total;
}

}  // namespace

TestResult triplesTest(const std::vector<double>& sample) {
  requireSample(sample, 5, "triples test of symmetry");
  std::vector<double> sorted = sample;
  std::sort(sorted.begin(), sorted.end());
  const Leaning sums = leaningOf(sorted);

  TestResult result;
  result.test = "triples";
  result.symbol = "z";
  result.n = sample.size();
  result.statistic = sums.total / std::sqrt(varianceOf(sums, static_cast<double>(sample.size())));
  result.p = 2 * boost::math::cdf(boost::math::normal(), -std::abs(result.statistic));
  result.method = sorted.front() == sorted.back() ? PMethod::kNothingToTest : PMethod::kNormalApproximation;
  return result;
}

}  // namespace fsr::statistics
