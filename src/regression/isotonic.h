#pragma once

#include <cstddef>
#include <vector>

namespace fsr::regression {

/// A run of neighbouring points that isotonic regression gives one level.
struct IsotonicBlock {
  std::size_t begin = 0;  ///< points begin .. end - 1
  std::size_t end = 0;
  double level = 0;   ///< their weighted mean
  double weight = 0;  ///< the sum of theirs
};

/// The never falling sequence of least weighted squares through `values`, by pooling adjacent violators
/// (Ayer et al., Annals of Mathematical Statistics 26 (1955) 641-647). Levels of the blocks rise strictly.
/// One positive weight for each value.
std::vector<IsotonicBlock> isotonicRegression(const std::vector<double>& values,
                                              const std::vector<double>& weights);

}  // namespace fsr::regression
