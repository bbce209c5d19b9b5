#include "statistics/wilcoxon_signed_rank.h"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <numeric>
#include <string>

#include "fsr_pressure_map/settings/input_error.h"
#include "statistics/ranks.h"
#include "statistics/samples.h"

namespace fsr::statistics {

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

}  // namespace fsr::statistics
