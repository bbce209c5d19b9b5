#include <algorithm>
#include <cmath>

#include "regression/grnn/kernel_mean.h"

namespace fsr::regression {

namespace {

// Sums over the samples on one side of a code, relative to the nearest of them.
struct Side {
  double sum = 0, weight = 0;
  double distance = INFINITY;  // of the code to that nearest one [counts]
};

// The side of every code, by one pass over the codes: between samples only the distance changes. `step` is 1
// for the samples at or below a code, -1 for those above it.
std::vector<Side> sides(const WeightedCodes& samples, double length, int step) {
  const auto codes = static_cast<std::ptrdiff_t>(samples.table_size);
  std::vector<Side> sides(samples.table_size);
  Side side;
  auto next = step > 0 ? std::size_t{0} : samples.code.size() - 1;  // wraps around at the end
  for (std::ptrdiff_t code = step > 0 ? 0 : codes - 1; code >= 0 && code < codes; code += step) {
    if (step < 0) sides[static_cast<std::size_t>(code)] = side;
    if (next < samples.code.size() && samples.code[next] == code) {
      const double decay = std::exp(-side.distance / length);
      side = {side.sum * decay + samples.sum[next], side.weight * decay + samples.count[next], 0.0};
      next += static_cast<std::size_t>(step);
    }
    if (step > 0) sides[static_cast<std::size_t>(code)] = side;
    side.distance += 1;
  }
  return sides;
}

}  // namespace

KernelMean laplaceMean(const WeightedCodes& samples, double length, LogWeight log_weight) {
  const std::vector<Side> below = sides(samples, length, 1), above = sides(samples, length, -1);
  KernelMean mean{std::vector<double>(samples.table_size), std::vector<double>(samples.table_size), {}};
  for (std::size_t code = 0; code < samples.table_size; ++code) {
    const double nearest = std::min(below[code].distance, above[code].distance);
    const double low = std::exp(-(below[code].distance - nearest) / length);
    const double high = std::exp(-(above[code].distance - nearest) / length);
    const double weight = below[code].weight * low + above[code].weight * high;
    mean.pressure[code] = (below[code].sum * low + above[code].sum * high) / weight;
    mean.weight[code] = weight * std::exp(-nearest / length);
    if (log_weight == LogWeight::kYes) mean.log_weight.push_back(std::log(weight) - nearest / length);
  }
  return mean;
}

}  // namespace fsr::regression
