#include "statistics/ranks.h"

#include <algorithm>
#include <cstddef>
#include <numeric>

namespace fsr::statistics {

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

}  // namespace fsr::statistics
