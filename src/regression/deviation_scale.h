#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace fsr::regression {

/// The part of the readings that shall lie within one deviation: that of a normal distribution.
constexpr double kShareWithinOneDeviation = 0.6827;

/// Finds by how much root mean squared errors must be scaled so that kShareWithinOneDeviation of the
/// errors lie within one: for normal errors by 1, for those of a hysteresis loop or of a long rest by
/// something else. The factor is found in up to 16 groups of neighbouring codes, so that the share holds
/// at rest as well as at full load; in a small group it is drawn towards the factor of all readings.
class DeviationScale {
 public:
  /// `readings` = number of readings at each code.
  explicit DeviationScale(const std::vector<double>& readings);

  /// `weight` readings at `code` have an error of `ratio` root mean squares, either sign.
  void add(std::uint16_t code, double ratio, double weight);

  /// The factor at each code: at a group's centre that of the group, between centres interpolated.
  /// 1 everywhere where nothing was added.
  std::vector<double> factors() const;

 private:
  static constexpr std::size_t kGroups = 16;
  static constexpr std::size_t kBins = 512;
  using Histogram = std::array<double, kBins>;

  static double quantile(const Histogram& histogram);

  std::vector<std::uint8_t> group_of_code_;
  std::array<double, kGroups> readings_{};
  std::array<double, kGroups> centre_{};  // mean code
  std::vector<Histogram> ratios_;
};

}  // namespace fsr::regression
