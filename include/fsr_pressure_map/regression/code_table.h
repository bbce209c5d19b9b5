#pragma once

#include <cstdint>
#include <vector>

namespace fsr::regression {

/// The table of any regressor of one reading: a converter gives integers, so pressure is a table over the
/// codes. All vectors but log_weight have full_scale + 1 entries. A taxel without a model (masked, or
/// constant in training) has NaN throughout.
struct CodeTable {
  std::vector<float> pressure;   ///< gauge pressure of each code [Pa], finite
  std::vector<float> deviation;  ///< one standard deviation of a held-out reading at each code [Pa], > 0
  std::vector<float> support;    ///< effective number of training samples behind each code
  /// Logarithm of the kernel sum at each code, if tables of several curvatures are combined by such sums;
  /// else empty.
  std::vector<float> log_weight;
  std::uint16_t lowest = 0;   ///< smallest code seen in training
  std::uint16_t highest = 0;  ///< largest code seen in training
};

}  // namespace fsr::regression
