#include "regression/deviation_scale.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace fsr::regression {

namespace {

// A quantile of fewer readings is unreliable, because readings that follow each other are alike.
constexpr double kLeastReadingsOfGroup = 500.0;
// The factor of all groups counts like this many readings of the group.
constexpr double kPriorOfScale = 100.0;
constexpr double kLargestRatio = 4.0;

}  // namespace

DeviationScale::DeviationScale(const std::vector<double>& readings) : group_of_code_(readings.size(), 0) {
  const double total = std::accumulate(readings.begin(), readings.end(), 0.0);
  const double groups = std::clamp(std::floor(total / kLeastReadingsOfGroup), 1.0, double{kGroups});
  double below = 0;
  for (std::size_t code = 0; code < readings.size(); ++code) {
    const auto group =
        static_cast<std::uint8_t>(total > 0 ? std::min(groups - 1, below / total * groups) : 0);
    group_of_code_[code] = group;
    readings_[group] += readings[code];
    centre_[group] += readings[code] * static_cast<double>(code);
    below += readings[code];
  }
  for (std::size_t group = 0; group < kGroups; ++group) {
    if (readings_[group] > 0) centre_[group] /= readings_[group];
  }
  ratios_.resize(static_cast<std::size_t>(groups), Histogram{});
}

void DeviationScale::add(std::uint16_t code, double ratio, double weight) {
  const double bin = std::min(std::abs(ratio) * (kBins / kLargestRatio), kBins - 1.0);
  ratios_[group_of_code_[code]][static_cast<std::size_t>(bin)] += weight;
}

double DeviationScale::quantile(const Histogram& histogram) {
  double missing = kShareWithinOneDeviation * std::accumulate(histogram.begin(), histogram.end(), 0.0);
  std::size_t bin = 0;
  while (bin + 1 < kBins && histogram[bin] < missing) missing -= histogram[bin++];
  const double inside = histogram[bin] > 0 ? missing / histogram[bin] : 1.0;
  return (static_cast<double>(bin) + inside) * (kLargestRatio / kBins);
}

std::vector<double> DeviationScale::factors() const {
  Histogram all{};
  for (const Histogram& group : ratios_) {
    std::transform(all.begin(), all.end(), group.begin(), all.begin(), std::plus<>());
  }
  std::vector<double> factors(group_of_code_.size(), 1.0);
  if (std::accumulate(all.begin(), all.end(), 0.0) == 0) return factors;
  const double of_all = quantile(all);
  double left_centre = 0, left_factor = 0;
  std::size_t code = 0;
  for (std::size_t group = 0; group < ratios_.size(); ++group) {
    if (readings_[group] == 0) continue;
    const double own = quantile(ratios_[group]);
    const double factor =
        (readings_[group] * own + kPriorOfScale * of_all) / (readings_[group] + kPriorOfScale);
    if (code == 0) left_factor = factor;  // constant below the first centre
    for (; code < factors.size() && static_cast<double>(code) <= centre_[group]; ++code) {
      const double width = centre_[group] - left_centre;
      const double share = width > 0 ? (static_cast<double>(code) - left_centre) / width : 1.0;
      factors[code] = left_factor + share * (factor - left_factor);
    }
    left_centre = centre_[group];
    left_factor = factor;
  }
  std::fill(factors.begin() + static_cast<std::ptrdiff_t>(code), factors.end(), left_factor);
  return factors;
}

}  // namespace fsr::regression
