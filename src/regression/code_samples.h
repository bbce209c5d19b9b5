#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "regression/code_statistics.h"

namespace fsr::regression {

/// Training readings of one taxel, one by one, for regressors that need more than sums: a forest draws
/// readings at random, and a monotone curve uses the readings at each pressure. The order of the readings has
/// no effect on any model.
struct CodeSamples {
  std::uint16_t full_scale = 0;
  std::vector<std::uint16_t> code;
  std::vector<FixedPressure> pressure;  ///< one for each code
  std::vector<double> curvature;        ///< one for each code [1/m]; empty = not used by the model

  std::size_t size() const { return code.size(); }
  void add(std::uint16_t reading, FixedPressure reference) {
    code.push_back(reading);
    pressure.push_back(reference);
  }
  /// Appends the readings of `other`. Both or neither must have curvature, and full scale must be the same.
  void append(const CodeSamples& other);
};

/// Throws InputError if the vectors differ in length or a code is above full scale.
void validate(const CodeSamples& samples);

/// Both throw InputError as validate() does, and if a sum would overflow.
CodeStatistics statisticsOf(const CodeSamples& samples);
CodeHistogram histogramOf(const CodeSamples& samples);

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
