#include "regression/pressure_grid.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace fsr::regression {

namespace {

FixedPressure floorTo(FixedPressure pressure, FixedPressure width) {
  const FixedPressure rest = pressure % width;
  return pressure - (rest < 0 ? rest + width : rest);
}

// Weight of a sample in each bin.
std::vector<double> binWeights(const CodeSamples& training, const PressureGrid& grid) {
  std::vector<double> count(grid.bins, 0.0);
  for (const FixedPressure pressure : training.pressure) ++count[grid.bin(pressure)];
  const auto occupied =
      static_cast<double>(grid.bins) - static_cast<double>(std::count(count.begin(), count.end(), 0.0));
  const double share = static_cast<double>(training.size()) / occupied;
  for (double& value : count) value = value > 0 ? share / value : 0.0;
  return count;
}

// Sorted by code and pressure, so that sums do not depend on the order of the samples.
std::vector<std::pair<std::uint16_t, FixedPressure>> sorted(const CodeSamples& training) {
  std::vector<std::pair<std::uint16_t, FixedPressure>> samples;
  samples.reserve(training.size());
  for (std::size_t i = 0; i < training.size(); ++i) {
    samples.emplace_back(training.code[i], training.pressure[i]);
  }
  std::sort(samples.begin(), samples.end());
  return samples;
}

}  // namespace

PressureGrid pressureGrid(const std::vector<FixedPressure>& pressure, std::size_t most_bins) {
  const auto [low, high] = std::minmax_element(pressure.begin(), pressure.end());
  PressureGrid grid;
  for (;; grid.width *= 2) {
    grid.first = floorTo(*low, grid.width);
    const FixedPressure bins = (*high - grid.first) / grid.width + 1;
    grid.bins = static_cast<std::size_t>(bins);
    if (grid.bins <= most_bins) return grid;
  }
}

WeightedCodes weightedByPressure(const CodeSamples& training) {
  validate(training);
  const PressureGrid grid = pressureGrid(training.pressure, kWeighingBins);
  const std::vector<double> weight = binWeights(training, grid);
  WeightedCodes codes;
  codes.table_size = training.full_scale + 1u;
  codes.samples = static_cast<double>(training.size());
  for (const auto& [code, pressure] : sorted(training)) {
    if (codes.code.empty() || codes.code.back() != code) {
      codes.code.push_back(code);
      codes.count.push_back(0);
      codes.sum.push_back(0);
    }
    const double share = weight[grid.bin(pressure)];
    codes.count.back() += share;
    codes.sum.back() += share * fromFixed(pressure);
  }
  codes.below.assign(codes.table_size + 1, 0);
  for (const std::int32_t code : codes.code) ++codes.below[static_cast<std::size_t>(code) + 1];
  std::partial_sum(codes.below.begin(), codes.below.end(), codes.below.begin());
  return codes;
}

}  // namespace fsr::regression
