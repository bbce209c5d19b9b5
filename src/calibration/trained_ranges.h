#pragma once

#include <vector>

#include "fsr_pressure_map/calibration/calibration.h"
#include "fsr_pressure_map/dataset/condition_classes.h"
#include "fsr_pressure_map/dataset/recording.h"

namespace fsr::calibration {

/// The ranges over the scans of those classes for which `trained` is true.
TrainedRanges findTrainedRanges(const std::vector<dataset::Recording>& recordings,
                                const dataset::ConditionClasses& classes, const std::vector<bool>& trained);

}  // namespace fsr::calibration
