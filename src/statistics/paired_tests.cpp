#include "statistics/paired_tests.h"

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <numeric>

#include "fsr_pressure_map/settings/input_error.h"
#include "statistics/samples.h"

namespace fsr::statistics {

std::string pMethodName(PMethod method) {
  switch (method) {
    case PMethod::kExact:
      return "exact";
    case PMethod::kParametric:
      return "parametric";
    case PMethod::kNormalApproximation:
      return "normal approximation";
    case PMethod::kChiSquaredApproximation:
      return "chi-squared approximation";
    case PMethod::kNothingToTest:
      return "nothing to test";
  }
  return "unknown";
}

Ranking midranks(const std::vector<double>& values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });

  Ranking ranking;
  ranking.ranks.resize(values.size());
  for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end) {
    while (end < order.size() && values[order[end]] == values[order[begin]]) ++end;
    const double t = static_cast<double>(end - begin);
    const double rank = 0.5 * static_cast<double>(begin + 1 + end);
    for (std::size_t i = begin; i < end; ++i) ranking.ranks[order[i]] = rank;
    ranking.tie_sum += t * t * t - t;
  }
  return ranking;
}

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

namespace {

const char* const kWilcoxon = "Wilcoxon signed-rank test";
constexpr std::size_t kMostExact = 1000;  // 2^-1000 is still a double

struct SignedRanks {
  std::vector<double> ranks;
  double tie_sum = 0;
  double positive = 0;  // V
};

SignedRanks signedRanks(const std::vector<double>& differences) {
  std::vector<double> magnitudes;
  for (const double d : differences) magnitudes.push_back(std::abs(d));
  const Ranking ranking = midranks(magnitudes);
  SignedRanks result{ranking.ranks, ranking.tie_sum, 0};
  for (std::size_t i = 0; i < differences.size(); ++i) {
    if (differences[i] > 0) result.positive += ranking.ranks[i];
  }
  return result;
}

/// P(sum of the ranks with a positive sign = s / 2) for every s, where all signs are equally likely. Ranks
/// are multiples of one half, hence the factor 2.
std::vector<double> distributionOfTwiceV(const std::vector<double>& ranks) {
  std::vector<double> probability = {1};
  for (const double rank : ranks) {
    const auto shift = static_cast<std::size_t>(std::lround(2 * rank));
    std::vector<double> next(probability.size() + shift, 0.0);
    for (std::size_t s = 0; s < probability.size(); ++s) {
      next[s] += 0.5 * probability[s];
      next[s + shift] += 0.5 * probability[s];
    }
    probability = std::move(next);
  }
  return probability;
}

double exactP(const SignedRanks& ranks) {
  const std::vector<double> probability = distributionOfTwiceV(ranks.ranks);
  const auto twice_v = static_cast<std::size_t>(std::lround(2 * ranks.positive));
  const std::size_t tail =
      std::min(twice_v, probability.size() - 1 - twice_v);  // the distribution is symmetric
  return std::min(1.0, 2 * std::accumulate(probability.begin(), probability.begin() + tail + 1, 0.0));
}

double normalP(const SignedRanks& ranks) {
  const double n = static_cast<double>(ranks.ranks.size());
  const double variance = n * (n + 1) * (2 * n + 1) / 24 - ranks.tie_sum / 48;
  const double distance = std::abs(ranks.positive - n * (n + 1) / 4);
  const double corrected = distance == 0 ? 0 : distance - 0.5;
  return std::min(1.0, 2 * boost::math::cdf(boost::math::normal(), -corrected / std::sqrt(variance)));
}

bool goesExact(WilcoxonMethod method, std::size_t n) {
  if (method != WilcoxonMethod::kExact) return method == WilcoxonMethod::kAuto && n < kWilcoxonExactBelow;
  if (n <= kMostExact) return true;
  throw settings::InputError(std::string(kWilcoxon) + ": exact p requested for " + std::to_string(n) +
                             " differences; it is computed for at most " + std::to_string(kMostExact));
}

}  // namespace

TestResult wilcoxonSignedRank(const std::vector<double>& first, const std::vector<double>& second,
                              WilcoxonMethod method) {
  std::vector<double> differences = pairedDifferences(first, second, kWilcoxon);
  TestResult result;
  result.test = "Wilcoxon signed-rank";
  result.symbol = "V";
  result.n = differences.size();
  differences.erase(std::remove(differences.begin(), differences.end(), 0.0), differences.end());
  result.dropped = result.n - differences.size();

  const SignedRanks ranks = signedRanks(differences);
  result.statistic = ranks.positive;
  if (differences.empty()) {
    result.p = 1;
    result.method = PMethod::kNothingToTest;
  } else if (goesExact(method, differences.size())) {
    result.p = exactP(ranks);
    result.method = PMethod::kExact;
  } else {
    result.p = normalP(ranks);
    result.method = PMethod::kNormalApproximation;
  }
  return result;
}

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
