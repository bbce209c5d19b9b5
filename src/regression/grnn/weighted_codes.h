#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "regression/code_statistics.h"
#include "regression/regressor.h"

namespace fsr::regression {

/// The codes that occur in training, ascending: the input of the regressors on sums.
struct WeightedCodes {
  std::size_t table_size = 0;      ///< full scale + 1
  double samples = 0;              ///< sum of `count`
  std::vector<std::int32_t> code;  ///< signed, for distances
  std::vector<double> count;       ///< weight of each code: its number of samples, unless bins are weighted
  std::vector<double> sum;         ///< of pressure, with the same weights [Pa]
  /// Number of occurring codes below each code 0 .. table_size.
  std::vector<std::int32_t> below;

  /// Index of the first code that is not below `reading`, which may be outside the table.
  std::size_t firstFrom(std::ptrdiff_t reading) const {
    const auto last = static_cast<std::ptrdiff_t>(table_size);
    const auto inside = static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(reading, 0, last));
    return static_cast<std::size_t>(below[inside]);
  }
};

WeightedCodes weightedCodes(const CodeHistogram& training);

/// Sample standard deviation of the training readings [counts], from exact integer sums; 0 if all are equal.
double readingDeviation(const CodeHistogram& training);

/// The answer if all readings are equal: their mean pressure at every code. Support is their number at that
/// code and 0 elsewhere.
Fit constantFit(const WeightedCodes& samples);

/// Bins of equal width over the training pressures. The width is a power of two [2^-20 Pa], and bin edges are
/// its multiples, so that nearly equal ranges of pressure have the same bins.
struct PressureGrid {
  FixedPressure width = 1;
  FixedPressure first = 0;  ///< lower edge of bin 0
  std::size_t bins = 0;

  std::size_t bin(FixedPressure pressure) const {
    return static_cast<std::size_t>((pressure - first) / width);
  }
};

/// The finest grid of at most `most_bins` bins, at least 2. `pressure` has at least one value.
PressureGrid pressureGrid(const std::vector<FixedPressure>& pressure, std::size_t most_bins);

/// Number of bins of equal weight for a GRNN that is to be independent of how long the chamber held each
/// pressure: up to 64, 8 to 16 kPa each over 0 to 620 kPa.
constexpr std::size_t kWeighingBins = 64;

/// The samples by code. Each pressure bin has the weight N / occupied bins, so that the weights add up to the
/// number of samples.
WeightedCodes weightedByPressure(const CodeSamples& training);

}  // namespace fsr::regression
