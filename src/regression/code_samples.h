#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "regression/code_statistics.h"

namespace fsr::regression {

/// Training readings of one taxel, one by one: for the regressors that sums do not serve (a forest
/// draws readings at random, a monotone curve looks at the reading of a pressure). Their order has no
/// effect on any model.
struct CodeSamples {
  std::uint16_t full_scale = 0;
  std::vector<std::uint16_t> code;
  std::vector<FixedPressure> pressure;  ///< one for each code
  std::vector<double> curvature;        ///< one for each code [1/m]; empty = the model has no use for it

  std::size_t size() const { return code.size(); }
  void add(std::uint16_t reading, FixedPressure reference) {
    code.push_back(reading);
    pressure.push_back(reference);
  }
  /// Appends another's readings. Both have curvature or neither has, and full scale is the same.
  void append(const CodeSamples& other);
};

/// Throws InputError where the vectors' lengths differ or a code is above full scale.
void validate(const CodeSamples& samples);

/// Both throw InputError as validate() does, or where a sum would overflow.
CodeStatistics statisticsOf(const CodeSamples& samples);
CodeHistogram histogramOf(const CodeSamples& samples);

}  // namespace fsr::regression
