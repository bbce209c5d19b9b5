#include "ros/bags/loaded_calibration.h"

#include <numeric>
#include <sstream>

#include "calibration/stages/deviation/interval_tally.h"
#include "check/check.h"
#include "fsr_pressure_map/calibration/calibration_file.h"
#include "fsr_pressure_map/settings/input_error.h"

namespace fsr_ros {

namespace {

float meanCurvature(const fsr::dataset::CurvatureClass& curvature_class) {
  const auto& values = curvature_class.curvature;
  const double sum = std::accumulate(values.begin(), values.end(), 0.0);
  return static_cast<float>(sum / static_cast<double>(values.size()));
}

}  // namespace

std::unique_ptr<LoadedCalibration> loadForUse(const std::string& path,
                                              const fsr::calibration::CalibratorOptions& options) {
  const fsr::calibration::Calibration calibration = fsr::calibration::loadCalibration(path);
  try {
    fsr::calibration::Calibrator calibrator(calibration, options);
    return std::make_unique<LoadedCalibration>(LoadedCalibration{
        toMessage(calibration, path), fsr::calibration::deviationText(calibration.budget.intervals.scale),
        std::move(calibrator), calibration.session_zero, calibration.temperature.present(),
        std::make_shared<const fsr::calibration::ShapeModel>(calibration.shape)});
  } catch (const fsr::settings::InputError& error) {
    throw fsr::settings::InputError(path + ": " + error.what());
  }
}

fsr_pressure_map::CalibrationInfo toMessage(const fsr::calibration::Calibration& calibration,
                                            const std::string& path) {
  fsr_pressure_map::CalibrationInfo info;
  info.id = calibration.id;
  info.path = path;
  info.scheme = fsr::compensation::schemeName(calibration.tables.scheme);
  info.model = calibration.regressor.name;
  info.sensor_serial = calibration.sensor.serial;
  info.pressure_low = calibration.trained.pressure.low;
  info.pressure_high = calibration.trained.pressure.high;
  info.temperature_low = calibration.trained.temperature.low;
  info.temperature_high = calibration.trained.temperature.high;
  info.curvature_low = calibration.trained.curvature.low;
  info.curvature_high = calibration.trained.curvature.high;
  info.pressure_rate_low = calibration.trained.pressure_rate.low;
  info.pressure_rate_high = calibration.trained.pressure_rate.high;
  info.parent = calibration.correction.parent;
  info.corrected = calibration.correction.date;
  for (const auto& curvature_class : calibration.tables.classes) {
    info.class_curvatures.push_back(meanCurvature(curvature_class));
  }
  return info;
}

std::string correctionText(const fsr_pressure_map::CalibrationInfo& info) {
  fsr::calibration::Correction correction;
  correction.parent = info.parent;
  correction.date = info.corrected;
  return fsr::check::correctionText(correction);
}

std::string describe(const LoadedCalibration& loaded) {
  const auto& info = loaded.info;
  const fsr::matrix::MatrixSize size = loaded.calibrator.layout().size;
  std::ostringstream text;
  text << info.scheme << " (" << info.model << "), id " << info.id << ", " << size.rows << " x "
       << size.columns << " taxels, trained from " << info.curvature_low << " to " << info.curvature_high
       << " 1/m in " << info.class_curvatures.size()
       << (info.class_curvatures.size() == 1 ? " class" : " classes");
  if (!info.parent.empty()) text << ", " << correctionText(info);
  return text.str();
}

}  // namespace fsr_ros
