#include "statistics/multiple_comparisons.h"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <string>

#include "fsr_pressure_map/settings/input_error.h"

namespace fsr::statistics {

namespace {

void requireProbabilities(const std::vector<double>& p) {
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (p[i] >= 0 && p[i] <= 1) continue;
    throw settings::InputError("correction for multiple tests: p value " + std::to_string(i + 1) + " is " +
                               std::to_string(p[i]) + "; it must lie between 0 and 1");
  }
}

std::vector<std::size_t> smallestFirst(const std::vector<double>& p) {
  std::vector<std::size_t> order(p.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return p[a] < p[b]; });
  return order;
}

}  // namespace

std::vector<double> bonferroni(const std::vector<double>& p) {
  requireProbabilities(p);
  std::vector<double> adjusted;
  for (const double value : p) adjusted.push_back(std::min(1.0, static_cast<double>(p.size()) * value));
  return adjusted;
}

std::vector<double> holm(const std::vector<double>& p) {
  requireProbabilities(p);
  const std::vector<std::size_t> order = smallestFirst(p);
  std::vector<double> adjusted(p.size());
  double largest = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    largest = std::max(largest, static_cast<double>(p.size() - i) * p[order[i]]);
    adjusted[order[i]] = std::min(1.0, largest);
  }
  return adjusted;
}

std::vector<double> benjaminiYekutieli(const std::vector<double>& p) {
  requireProbabilities(p);
  const std::vector<std::size_t> order = smallestFirst(p);
  double dependence = 0;
  for (std::size_t i = 1; i <= p.size(); ++i) dependence += 1 / static_cast<double>(i);
  std::vector<double> adjusted(p.size());
  double smallest = 1;
  for (std::size_t i = p.size(); i-- > 0;) {
    const double share = static_cast<double>(p.size()) / static_cast<double>(i + 1);
    smallest = std::min(smallest, share * dependence * p[order[i]]);
    adjusted[order[i]] = smallest;
  }
  return adjusted;
}

}  // namespace fsr::statistics
