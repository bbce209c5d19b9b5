#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace fsr::compensation {

/// Place of a number between evenly spaced knots.
struct EvenPlace {
  std::size_t below = 0;  ///< knot below; at most the last but one
  double share = 0;       ///< of the knot above, 0 to 1
};

/// A line of straight pieces between evenly spaced knots, constant beyond them.
class EvenLine {
 public:
  EvenLine() = default;
  /// `knots`: two or more, evenly spaced and ascending, one for each of `values`.
  EvenLine(const std::vector<double>& knots, std::vector<double> values)
      : first_(knots.front()),
        per_unit_(static_cast<double>(knots.size() - 1) / (knots.back() - knots.front())),
        values_(std::move(values)) {}

  static EvenPlace place(double x, double first, double per_unit, std::size_t knots) {
    const double last = static_cast<double>(knots - 1);
    const double at = std::min(std::max((x - first) * per_unit, 0.0), last);
    const auto below = std::min(static_cast<std::size_t>(at), knots - 2);
    return {below, at - static_cast<double>(below)};
  }

  double operator()(double x) const {
    const EvenPlace at = place(x, first_, per_unit_, values_.size());
    return values_[at.below] + at.share * (values_[at.below + 1] - values_[at.below]);
  }

 private:
  double first_ = 0;
  double per_unit_ = 0;  // knots for each unit
  std::vector<double> values_;
};

}  // namespace fsr::compensation
