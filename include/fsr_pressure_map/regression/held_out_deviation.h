#pragma once

#include <cstdint>
#include <vector>

#include "fsr_pressure_map/regression/code_statistics.h"

namespace fsr {

/// The part of the readings that shall lie within one deviation: that of a normal distribution.
constexpr double kShareWithinOneDeviation = 0.6827;

/// Held-out errors of one model by code, collected section by section.
class HeldOutErrors {
 public:
  explicit HeldOutErrors(std::uint16_t full_scale);

  /// Errors of `pressure` [Pa, one for each code] on the readings of `held_out`.
  void add(const CodeStatistics& held_out, const std::vector<double>& pressure);

  bool empty() const { return readings_.empty(); }

  /// One standard deviation of a held-out reading at each code [Pa], > 0: the root of the mean
  /// squared error of the code, drawn towards that of its neighbourhood and, where the whole
  /// neighbourhood is rare, of all codes; scaled so that kShareWithinOneDeviation of the errors lie
  /// within one (a hysteresis loop's errors are no normal distribution); never below the pressure
  /// step of one count there, nor below 1 Pa.
  ///
  /// `pressure` is the model's answer at each code, whose slope gives the step.
  std::vector<float> deviation(const std::vector<double>& pressure) const;

 private:
  // The errors of one code in one section: their number, mean and spread about the mean [Pa].
  struct Readings {
    std::uint16_t code;
    double count;
    double mean;
    double spread;
  };

  std::vector<double> smoothedMeanSquare() const;
  double scale(const std::vector<double>& deviation) const;

  std::size_t codes_;
  std::vector<Readings> readings_;
};

}  // namespace fsr
