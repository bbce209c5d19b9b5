#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "calibration/stages/session/tare.h"
#include "fsr_pressure_map/calibration/shape.h"
#include "fsr_pressure_map/matrix/scan.h"
#include "statistics/samples.h"

namespace fsr::calibration {

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
