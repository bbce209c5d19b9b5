#pragma once

#include <limits>
#include <string>

namespace fsr::settings {

/// Permitted interval of a setting, including both ends, with the unit that messages print.
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  std::string unit = {};  ///< e.g. "Pa"; empty = a pure number

  bool contains(double value) const { return value >= low && value <= high; }  // false for NaN

  /// "0 to 793000 Pa", "0.01 m or more", "2 or less".
  std::string text() const;
};

}  // namespace fsr::settings
