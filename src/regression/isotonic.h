#pragma once

#include <cstddef>
#include <vector>

namespace fsr::regression {

/// A run of neighbouring points with the same value in an isotonic regression.
struct IsotonicBlock {
  std::size_t begin = 0;  ///< points begin .. end - 1
  std::size_t end = 0;
  double level = 0;   ///< weighted mean of the points
  double weight = 0;  ///< sum of the weights
};

/// The non-decreasing sequence with the least weighted sum of squares through `values`, by pooling adjacent
/// violators (Ayer et al., Annals of Mathematical Statistics 26 (1955) 641-647). Levels of the blocks
/// increase strictly. One positive weight for each value.
std::vector<IsotonicBlock> isotonicRegression(const std::vector<double>& values,
                                              const std::vector<double>& weights);

}  // namespace fsr::regression
