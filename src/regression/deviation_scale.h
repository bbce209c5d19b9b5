#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace fsr::regression {

/// Share of the readings within one deviation, as for a normal distribution.
constexpr double kShareWithinOneDeviation = 0.6827;

/// Scales root mean squared errors so that kShareWithinOneDeviation of the errors are within one deviation.
/// For normally distributed errors the factor is 1; for errors from hysteresis or from a long rest it is not.
/// The factor is found in up to 16 groups of neighbouring codes, so that the share is right at rest as well
/// as at full load. In a small group the factor is shrunk towards that of all readings.
class DeviationScale {
 public:
  /// `readings` [codes]: number of readings at each code.
  explicit DeviationScale(const std::vector<double>& readings);

  /// `weight` readings at `code` have an error of `ratio` root mean squares, of either sign.
  void add(std::uint16_t code, double ratio, double weight);

  /// The factor at each code: at the centre of a group that of the group, interpolated between centres. 1
  /// everywhere if nothing was added.
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
