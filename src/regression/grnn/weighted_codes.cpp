#include "regression/grnn/weighted_codes.h"

#include <cmath>
#include <numeric>
#include <utility>

#include "regression/grnn/vector_width.h"

namespace fsr::regression {

namespace {

// This many squares of a 16-bit code add up exactly in a double.
constexpr std::uint64_t kExactSamples = std::uint64_t{1} << 21;

}  // namespace

WeightedCodes weightedCodes(const CodeHistogram& training) {
  const std::vector<std::int64_t>& count = training.count();
  const std::size_t occupied = count.size() - std::count(count.begin(), count.end(), 0);
  // Every code is written, but kept only if it occurs. This avoids a branch that would be mispredicted and
  // needs room for one more.
  WeightedCodes samples{count.size(),
                        static_cast<double>(training.samples()),
                        std::vector<std::int32_t>(occupied + 1),
                        std::vector<double>(occupied + 1),
                        std::vector<double>(occupied + 1),
                        std::vector<std::int32_t>(count.size() + 1)};
  std::size_t found = 0;
  const auto occurs = [](std::int64_t number) { return number != 0; };
  const auto first =
      static_cast<std::size_t>(std::find_if(count.begin(), count.end(), occurs) - count.begin());
  std::size_t code = first;  // no code occurs below `first`, nor after all have been found
  for (; found < occupied; ++code) {
    samples.code[found] = static_cast<std::int32_t>(code);
    samples.count[found] = static_cast<double>(count[code]);
    samples.sum[found] = fromFixed(training.sum()[code]);
    samples.below[code] = static_cast<std::int32_t>(found);
    found += count[code] != 0;
  }
  std::fill(samples.below.begin() + static_cast<std::ptrdiff_t>(code), samples.below.end(),
            static_cast<std::int32_t>(found));
  samples.code.pop_back();
  samples.count.pop_back();
  samples.sum.pop_back();
  return samples;
}

namespace {

struct Moments {
  double sum = 0, squares = 0;
};

// Sums of count x code and count x code^2 in doubles, lane by lane. All values are whole numbers and exact.
FSR_EACH_VECTOR_WIDTH
Moments momentsOf(const std::int64_t* count, std::size_t codes) {
  constexpr std::size_t kLanes = 8;
  double reading[kLanes], sum[kLanes] = {}, squares[kLanes] = {};
  for (std::size_t i = 0; i < kLanes; ++i) reading[i] = static_cast<double>(i);
  std::size_t code = 0;
  for (; code + kLanes <= codes; code += kLanes) {
    for (std::size_t i = 0; i < kLanes; ++i) {
      const double product = static_cast<double>(count[code + i]) * reading[i];
      sum[i] += product;
      squares[i] += product * reading[i];
      reading[i] += kLanes;
    }
  }
  Moments all;
  for (; code < codes; ++code) {
    all.sum += static_cast<double>(count[code]) * static_cast<double>(code);
    all.squares += static_cast<double>(count[code]) * static_cast<double>(code * code);
  }
  for (std::size_t i = 0; i < kLanes; ++i) {
    all.sum += sum[i];
    all.squares += squares[i];
  }
  return all;
}

// number (number - 1) times the variance of the readings, exact.
Int128 scatterOf(const CodeHistogram& training) {
  const std::vector<std::int64_t>& count = training.count();
  const Int128 number = training.samples();
  if (training.samples() <= kExactSamples) {
    const Moments moments = momentsOf(count.data(), count.size());
    const auto sum = static_cast<std::int64_t>(moments.sum);
    return number * static_cast<std::int64_t>(moments.squares) - Int128{sum} * sum;
  }
  Int128 sum = 0, squares = 0;
  for (std::size_t code = 0; code < count.size(); ++code) {
    sum += Int128{count[code]} * code;
    squares += Int128{count[code]} * (code * code);
  }
  return number * squares - sum * sum;
}

}  // namespace

double readingDeviation(const CodeHistogram& training) {
  if (training.samples() < 2) return 0.0;
  const auto number = static_cast<double>(training.samples());
  return std::sqrt(static_cast<double>(scatterOf(training)) / (number * (number - 1)));
}

Fit constantFit(const WeightedCodes& samples) {
  Fit fit{std::vector<double>(samples.table_size, samples.sum.front() / samples.count.front()),
          std::vector<double>(samples.table_size, 0.0)};
  fit.support[static_cast<std::size_t>(samples.code.front())] = samples.count.front();
  return fit;
}

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
