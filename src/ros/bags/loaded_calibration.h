#pragma once

#include <fsr_pressure_map/CalibrationInfo.h>

#include <memory>
#include <string>

#include "fsr_pressure_map/calibration/calibration.h"
#include "fsr_pressure_map/calibration/calibrator.h"

namespace fsr_ros {

/// A calibration ready for scans: its file read and checked, its tables packed. Making one takes a fraction
/// of a second, so it is made beside the scans and then swapped in.
struct LoadedCalibration {
  fsr_pressure_map::CalibrationInfo info;  ///< header left empty
  fsr::calibration::Calibrator calibrator;
};

/// Throws fsr::InputError that names the file and what is wrong with it.
std::unique_ptr<LoadedCalibration> loadForUse(const std::string& path,
                                              const fsr::calibration::CalibratorOptions& options);

/// Header left empty.
fsr_pressure_map::CalibrationInfo toMessage(const fsr::calibration::Calibration& calibration,
                                            const std::string& path);

/// "per_curvature (grnn), id 3f2a..., 7 x 10 taxels, 6 curvatures from 0 to 20 1/m".
std::string describe(const LoadedCalibration& loaded);

}  // namespace fsr_ros
