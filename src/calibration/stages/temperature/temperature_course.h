#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "dataset/sections.h"
#include "fsr_pressure_map/calibration/calibration.h"
#include "fsr_pressure_map/calibration/temperature.h"
#include "fsr_pressure_map/dataset/recording.h"
#include "rheology/memory.h"

namespace fsr::calibration {

class Calibrator;

/// The mean temperature of the cycles must differ by more than this, or a model of the temperature cannot be
/// trained: the usual thermometers err by some tenths of a kelvin [K].
constexpr double kLeastTemperatureSpan = 0.5;

/// What a model of the temperature may be made of.
struct TemperatureGrid {
  std::vector<double> lags;  ///< [s]; empty = none can be trained
  double reference = 0;      ///< mean temperature [degree Celsius]
  double low = 0;            ///< [degree Celsius]
  double high = 0;
};

/// The grid of these recordings. Lags are no longer than a third of the longest recording. Without lags where
/// a recording has no temperature, or where the mean temperatures of the cycles differ by
/// kLeastTemperatureSpan or less.
TemperatureGrid temperatureGrid(const std::vector<dataset::Recording>& recordings,
                                const std::vector<dataset::Sections>& sections);

/// Whether each scan of the recordings has a temperature.
bool haveTemperature(const std::vector<dataset::Recording>& recordings);

/// T_lag at each scan [degree Celsius]; lag 0 = the measured temperature. See TemperatureModel.
std::vector<double> sheetTemperature(const dataset::Recording& recording, double lag);

/// The mean of `values` over the cycle of each scan; 0 for scans that belong to none.
std::vector<double> cycleMeans(const std::vector<double>& values, const dataset::Recording& recording,
                               const dataset::Sections& sections);

/// The recordings with the pressure at which the sheet would have given the same readings at T_0. A taxel's
/// table of these is its table at T_0.
std::vector<dataset::Recording> atReference(std::vector<dataset::Recording> recordings,
                                            const TemperatureModel& model);

/// Gives the temperature of one scan to a live map, if the recording has temperatures.
void setTemperatureOf(const dataset::Recording& recording, std::size_t scan, const Calibration& calibration,
                      Calibrator& calibrator);

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
