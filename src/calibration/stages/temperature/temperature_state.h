#pragma once

#include <cstddef>
#include <limits>
#include <optional>

#include "fsr_pressure_map/calibration/temperature.h"
#include "rheology/memory.h"

namespace fsr::calibration {

/// 1 + s (T_lag - T_0), but between 1/2 and 2 for any input.
double temperatureFactor(const TemperatureModel& model, double sheet_temperature);

/// The temperature of the sheet under a live map.
class TemperatureState {
 public:
  /// `model` must be present().
  explicit TemperatureState(const TemperatureModel& model);

  /// The measured temperature from now on [degree Celsius], limited to those of training and `margin` [K]
  /// beyond; NaN = not known.
  void setTemperature(double temperature, double margin) noexcept;

  /// Begins the scan of `time` [s]. Only time that runs back starts the low-pass anew.
  void beginScan(double time) noexcept;

  /// Corrects the answers of the taxels in the scan that was begun. While the temperature is not known the
  /// pressure stays, and the deviation contains the effect of the temperatures of training.
  void correct(std::size_t taxels, float* pressure, float* deviation) const noexcept;

  double factor() const { return factor_; }

 private:
  TemperatureModel model_;
  std::optional<rheology::ExponentialMemory> lag_;
  double measured_ = std::numeric_limits<double>::quiet_NaN();  // limited [degree Celsius]
  double before_ = measured_;                                   // at the scan before
  double sheet_ = measured_;                                    // T_lag
  double time_ = measured_;                                     // of the scan [s]
  double factor_ = 1;
  double unknown_;  // share of the pressure that the deviation contains; 0 = the temperature is known
};

}  // namespace fsr::calibration
