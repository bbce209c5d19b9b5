#pragma once

#include <cstddef>
#include <vector>

#include "regression/code_samples.h"
#include "regression/grnn/weighted_codes.h"

namespace fsr::regression {

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
