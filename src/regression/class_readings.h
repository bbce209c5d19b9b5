#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "regression/code_samples.h"
#include "regression/code_statistics.h"

namespace fsr::regression {

/// Training readings of one taxel by curvature class: all readings or a part of them (some sections, a random
/// draw). Classes may be empty.
struct ClassReadings {
  std::uint16_t full_scale = 0;
  /// [classes]: sums by code, sufficient for mergeable regressors (linear, GRNN).
  std::vector<CodeHistogram> sums;
  /// [classes]: the same readings one by one, for the other regressors (forest, monotone); empty where sums
  /// suffice.
  std::vector<CodeSamples> samples;

  std::size_t classes() const { return samples.empty() ? sums.size() : samples.size(); }
  std::uint64_t readings(std::size_t curvature_class) const {
    return samples.empty() ? sums[curvature_class].samples() : samples[curvature_class].size();
  }
};

}  // namespace fsr::regression
