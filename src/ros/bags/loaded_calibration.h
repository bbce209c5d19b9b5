#pragma once

#include <fsr_pressure_map/CalibrationInfo.h>

#include <memory>
#include <string>

#include "fsr_pressure_map/calibration/calibration.h"
#include "fsr_pressure_map/calibration/calibrator.h"

namespace fsr_ros {

/// A calibration that is ready for use: the file is read and checked, and the tables are packed. This takes a
/// fraction of a second, so it is done in another thread than the scans, and the result is swapped in.
struct LoadedCalibration {
  fsr_pressure_map::CalibrationInfo info;  ///< without header
  std::string deviation;                   ///< of the map, see deviationText()
  fsr::calibration::Calibrator calibrator;
  fsr::calibration::SessionZero session_zero;  ///< whether a tare is expected, and what it is worth
  bool corrects_temperature;                   ///< it has a model of the temperature
  /// How the unloaded sheet reads on each surface.
  std::shared_ptr<const fsr::calibration::ShapeModel> shape;

  /// The temperature of the sheet [degree Celsius]; NaN = not known.
  void setTemperature(double temperature) {
    calibrator.setTemperature(temperature, info.temperature_low, info.temperature_high);
  }
};

/// Loads a calibration file. Throws fsr::InputError that names the file and what is wrong with it.
std::unique_ptr<LoadedCalibration> loadForUse(const std::string& path,
                                              const fsr::calibration::CalibratorOptions& options);

/// The description that the calibration node publishes, without header.
fsr_pressure_map::CalibrationInfo toMessage(const fsr::calibration::Calibration& calibration,
                                            const std::string& path);

/// "corrected on 2026-11-23 from 3f2a01c4d5e6"; "" for a calibration that was trained.
std::string correctionText(const fsr_pressure_map::CalibrationInfo& info);

/// One line for the log: "per_curvature (grnn), id 3f2a..., 7 x 10 taxels, trained from 0 to 20 1/m in 6
/// classes".
std::string describe(const LoadedCalibration& loaded);

}  // namespace fsr_ros
