#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "fsr_pressure_map/regression/code_samples.h"
#include "fsr_pressure_map/regression/code_statistics.h"

namespace fsr::compensation {

/// Training readings of one taxel, by curvature class: all of them or any part (some sections, a
/// random draw). Classes may be empty.
struct ClassReadings {
  std::uint16_t full_scale = 0;
  /// One for each class: all that a mergeable regressor needs (linear, GRNN).
  std::vector<regression::CodeHistogram> sums;
  /// The same readings one by one, for the others (forest, monotone); empty where sums serve.
  std::vector<regression::CodeSamples> samples;

  std::size_t classes() const { return samples.empty() ? sums.size() : samples.size(); }
  std::uint64_t readings(std::size_t curvature_class) const {
    return samples.empty() ? sums[curvature_class].samples() : samples[curvature_class].size();
  }
};

}  // namespace fsr::compensation
