#pragma once

#include <limits>
#include <vector>

#include "fsr_pressure_map/dataset/condition_classes.h"
#include "fsr_pressure_map/dataset/recording.h"

namespace fsr::calibration {

/// Lowest and highest value over training; NaN = not recorded.
struct TrainedInterval {
  double low = std::numeric_limits<double>::quiet_NaN();
  double high = std::numeric_limits<double>::quiet_NaN();

  bool known() const { return low <= high; }  // false for NaN
  /// NaN changes nothing.
  void include(double value);
};

struct TrainedRanges {
  TrainedInterval pressure;       ///< chamber, gauge [Pa]
  TrainedInterval pressure_rate;  ///< of the chamber over one second, negative while venting [Pa/s]
  TrainedInterval curvature;      ///< principal curvature, of all taxels [1/m]
  TrainedInterval temperature;    ///< [degree Celsius]
};

/// The ranges over the scans of those classes for which `trained` is true.
TrainedRanges findTrainedRanges(const std::vector<dataset::Recording>& recordings,
                                const dataset::ConditionClasses& classes, const std::vector<bool>& trained);

}  // namespace fsr::calibration
