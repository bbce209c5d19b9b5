#pragma once

#include <fsr_pressure_map/MatrixInfo.h>

#include <memory>
#include <string>

#include "exports/scan_record.h"
#include "ros/bags/loaded_calibration.h"

namespace fsr_ros {

/// Computes the maps of recorded scans with a calibration file.
class MapMaker {
 public:
  /// `path` of a calibration file; empty = no maps are computed. Throws fsr::InputError.
  MapMaker(const std::string& path, const fsr_pressure_map::MatrixInfo& board);

  /// Description of the calibration; nullptr without one.
  const fsr_pressure_map::CalibrationInfo* info() const { return loaded_ ? &loaded_->info : nullptr; }

  /// Adds the map to a scan. The scans must come in time order. Throws fsr::InputError if the scan does not
  /// fit the calibration.
  void make(fsr::exports::ScanRecord& scan);

 private:
  std::unique_ptr<LoadedCalibration> loaded_;
  std::shared_ptr<const fsr::matrix::Surface> surface_;
};

}  // namespace fsr_ros
