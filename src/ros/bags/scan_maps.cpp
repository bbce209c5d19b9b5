#include "ros/bags/scan_maps.h"

#include <utility>

#include "fsr_pressure_map/settings/input_error.h"

namespace fsr_ros {

MapMaker::MapMaker(const std::string& path, const fsr_pressure_map::MatrixInfo& board) {
  if (path.empty()) return;
  loaded_ = loadForUse(path, {});
  const std::string& serial = loaded_->info.sensor_serial;
  loaded_->calibrator.setWrongSensor(!serial.empty() && !board.serial.empty() && serial != board.serial);
  if (board.mask.size() == loaded_->calibrator.layout().size.taxels()) {
    loaded_->calibrator.setMask(board.mask);
  }
}

void MapMaker::make(fsr::exports::ScanRecord& scan) {
  if (!loaded_ || scan.counts.empty()) return;
  const double time = 1e-9 * static_cast<double>(scan.stamp_ns);
  if (scan.surface != surface_ && scan.surface != nullptr) {
    surface_ = scan.surface;
    loaded_->calibrator.setSurface(*surface_, time);
  }
  loaded_->setTemperature(scan.temperature);
  fsr::map::PressureMap map;
  loaded_->calibrator.calibrate({scan.layout.size, scan.full_scale, scan.counts.data(), scan.counts.size()},
                                time, map);
  if (map.state == fsr::map::MapState::kSizeMismatch) {
    throw fsr::settings::InputError("the scans have " + fsr::matrix::sizeText(scan.layout.size) +
                                    " taxels and up to " + std::to_string(scan.full_scale) +
                                    " counts, but the calibration is for " +
                                    fsr::matrix::sizeText(loaded_->calibrator.layout().size) +
                                    " taxels or another full scale; give the calibration of this matrix");
  }
  scan.layout = map.layout;
  scan.map = std::move(map);
}

}  // namespace fsr_ros
