#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "calibration/stages/session/session_rests.h"
#include "calibration/stages/session/tare.h"
#include "fsr_pressure_map/calibration/shape.h"
#include "fsr_pressure_map/dataset/recording.h"
#include "fsr_pressure_map/matrix/scan.h"
#include "statistics/samples.h"

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

/// A chamber within this of ambient puts no load on the sheet [Pa].
constexpr double kUnloaded = 2e3;
/// A reading that is 0 in a larger share of the scans is cut by the converter's lower end.
constexpr double kCutShare = 0.1;

/// Collects scans of the unloaded sheet until their mean can be compared with a model of its shape.
class RestWindow {
 public:
  /// `options`: the window and its limit of scatter. `model` must be present.
  RestWindow(const ShapeModel& model, const TareOptions& options);

  /// `ignored`: [taxels], 1 = dead, stuck or masked. True once the window is full. If time runs backwards,
  /// the window starts again. A scan of another size or full scale is left out.
  bool add(const matrix::ScanView& scan, const std::vector<std::uint8_t>& ignored, double time);

  /// The means. Throws InputError that names the taxel whose reading scatters most, if it is more than a
  /// sheet at rest does.
  RestReading reading() const;

 private:
  matrix::Layout layout_;
  std::uint16_t full_scale_;
  std::vector<double> scale_;  // [taxels], see ShapeModel [Pa]
  TareOptions options_;
  std::vector<statistics::RunningMoments> moments_;  // [taxels], of readings [counts]
  std::vector<double> zeros_;                        // [taxels], number of readings that are 0
  std::size_t scans_ = 0;
  double start_ = 0, last_ = 0;  // [s]
};

}  // namespace fsr::calibration
