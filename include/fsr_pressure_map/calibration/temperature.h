#pragma once

namespace fsr::calibration {

/// The effect of the temperature of the sheet, one factor of the pressure for all taxels:
///
///     p = p_0 (1 + s (T_lag - T_0))
///
/// p_0 is the pressure by tables and history model, which are trained for T_0. T_lag is the temperature of
/// the sheet: a low-pass of first order of the measured temperature, which starts at the first measured
/// value.
struct TemperatureModel {
  double sensitivity = 0;  ///< s [1/K]; 0 = the pressure does not depend on temperature
  double reference = 0;    ///< T_0, the mean of training [degree Celsius]
  double lag = 0;          ///< time constant of T_lag [s]; 0 = the sheet has the measured temperature
  double low = 0;          ///< measured temperatures of training [degree Celsius]
  double high = 0;
  double spread = 0;  ///< standard deviation of T_lag in training [K]

  bool present() const { return sensitivity != 0; }
};

}  // namespace fsr::calibration
