#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace fsr::conductor {

/// What the taxels read without load, and how noisy it is. Memory does not grow with time.
class RestCounts {
 public:
  static constexpr unsigned kLeastScans = 20;

  void restart();
  /// A scan at rest.
  void take(const std::uint16_t* counts, std::size_t taxels);
  bool known() const { return scans_ >= kLeastScans; }
  /// How many taxels read more than noise does at rest. All of them while that is not known.
  std::size_t answering(const std::uint16_t* counts, std::size_t taxels) const;
  /// Sum over the taxels above their means at rest [counts]; NaN while that is not known.
  double excess(const std::uint16_t* counts, std::size_t taxels) const;
  /// Standard deviation of a single reading, median over the taxels [counts]. The board cuts off what is
  /// below 0, which hides up to 42 % of the deviation; it is given back. 0 while it is not known.
  double noise() const;

 private:
  unsigned scans_ = 0;
  std::vector<double> mean_, squares_;      // of each taxel
  std::vector<double> last_, differences_;  // of each taxel: last scan, sum of squared differences
};

}  // namespace fsr::conductor
