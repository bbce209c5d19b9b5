#pragma once

#include <string>

#include "fsr_pressure_map/calibration/calibration_file.h"
#include "fsr_pressure_map/settings/input_error.h"

namespace test_support {

/// What loading the calibration file says, without the path; "accepted" if it loads.
inline std::string fileComplaint(const std::string& path) {
  try {
    fsr::calibration::loadCalibration(path, fsr::calibration::CalibrationParts::kAll);
  } catch (const fsr::settings::InputError& error) {
    const std::string said = error.what();
    return said.rfind(path + ": ", 0) == 0 ? said.substr(path.size() + 2) : "without the path: " + said;
  }
  return "accepted";
}

/// The same of a calibration that is saved with one thing spoilt.
template <typename Spoil>
std::string fileComplaint(fsr::calibration::Calibration calibration, const std::string& path, Spoil spoil) {
  spoil(calibration);
  fsr::calibration::saveCalibration(calibration, path);
  return fileComplaint(path);
}

}  // namespace test_support
