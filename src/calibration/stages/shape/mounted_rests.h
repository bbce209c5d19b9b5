#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "calibration/stages/session/session_rests.h"
#include "fsr_pressure_map/calibration/shape.h"
#include "fsr_pressure_map/dataset/recording.h"

namespace fsr::calibration {

/// The mean reading of each taxel over the scans. Taxels that are masked have none.
RestReading readingAtRest(const dataset::Recording& recording, const std::vector<std::size_t>& scans);

/// One mount of the sheet, with the readings at the first rest of the bags on it.
struct MountedRest {
  std::string name;  ///< e.g. "a.bag, flat, mount 2"
  matrix::Surface surface;
  std::size_t curvature_class = 0;
  RestReading rest;
  std::string serial;      ///< of the board; empty = unknown
  double temperature = 0;  ///< at the rest of its first bag [degree Celsius]; NaN = not recorded
  /// [taxels] What the loads of its first bag left behind: the last rest after them minus the rest before
  /// [counts]; NaN = no reading; empty = there is no such rest.
  std::vector<double> left_behind;
};

/// The mounts that start with a rest at ambient pressure. Sessions with the same class and mount number are
/// one mount.
std::vector<MountedRest> mountedRests(const std::vector<dataset::Recording>& recordings,
                                      const Sessions& sessions);

/// The names of the other mounts: none of their bags starts with a rest at ambient pressure.
std::vector<std::string> mountsWithoutRest(const std::vector<dataset::Recording>& recordings,
                                           const Sessions& sessions);

}  // namespace fsr::calibration
