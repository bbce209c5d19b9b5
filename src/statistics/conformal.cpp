#include "statistics/conformal.h"

#include <cmath>

namespace fsr::statistics {

namespace {

constexpr double kRounding = 1e-9;  // (n + 1) level of 19.000000000000004 is 19
constexpr double kMedian = 0.5;
constexpr double kOutside = 0.05;  // share of the trainings below ConformalCover::low, and above `high`

// Quantile of Beta(k, n + 1 - k), the distribution of the k-th smallest of n uniform numbers.
double orderQuantile(std::size_t n, std::size_t k, double probability) {
  double low = 0, high = 1;
  for (int i = 0; i < 50; ++i) {
    const double middle = (low + high) / 2;
    (probabilityOfAtLeast(k, std::vector<double>(n, middle)) < probability ? low : high) = middle;
  }
  return high;
}

}  // namespace

std::optional<std::size_t> conformalRank(std::size_t units, double level) {
  const auto rank = static_cast<std::size_t>(std::ceil((static_cast<double>(units) + 1) * level - kRounding));
  if (rank > units || rank == 0) return std::nullopt;
  return rank;
}

std::optional<ConformalCover> conformalCover(std::size_t units, double level) {
  const std::optional<std::size_t> rank = conformalRank(units, level);
  if (!rank) return std::nullopt;
  const std::size_t k = *rank;
  return ConformalCover{k, static_cast<double>(k) / (static_cast<double>(units) + 1),
                        orderQuantile(units, k, kOutside), orderQuantile(units, k, kMedian),
                        orderQuantile(units, k, 1 - kOutside)};
}

std::size_t conformalUnits(double level) {
  return static_cast<std::size_t>(std::ceil(level / (1 - level) - kRounding));
}

double probabilityOfAtLeast(std::size_t k, const std::vector<double>& probability) {
  // Of exactly 0, 1, ... events among those seen so far.
  std::vector<double> exactly(probability.size() + 1, 0.0);
  exactly[0] = 1;
  for (std::size_t seen = 0; seen < probability.size(); ++seen) {
    const double p = probability[seen];
    for (std::size_t events = seen + 1; events > 0; --events)
      exactly[events] = exactly[events] * (1 - p) + exactly[events - 1] * p;
    exactly[0] *= 1 - p;
  }
  double sum = 0;
  for (std::size_t events = k; events < exactly.size(); ++events) sum += exactly[events];
  return sum;
}

std::size_t medianThreshold(std::size_t rank, std::size_t thresholds,
                            const std::function<std::vector<double>(std::size_t)>& shares) {
  std::size_t low = 0, high = thresholds - 1;
  while (low < high) {
    const std::size_t middle = low + (high - low) / 2;
    if (probabilityOfAtLeast(rank, shares(middle)) >= kMedian) {
      high = middle;
    } else {
      low = middle + 1;
    }
  }
  return low;
}

std::optional<std::size_t> conformalThreshold(std::size_t units, double level, std::size_t thresholds,
                                              const std::function<std::vector<double>(std::size_t)>& shares) {
  const std::optional<std::size_t> rank = conformalRank(units, level);
  if (!rank) return std::nullopt;
  return medianThreshold(*rank, thresholds, shares);
}

}  // namespace fsr::statistics
