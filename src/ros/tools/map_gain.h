#pragma once

#include <string>
#include <vector>

#include "fsr_pressure_map/calibration/history.h"
#include "fsr_pressure_map/dataset/recording.h"

namespace fsr_ros {

/// The family that describes these effects: one that depends on earlier extremes is a loop, one that depends
/// on the time since the last reversal fades. kNone if none of them does.
fsr::calibration::HistoryFamily historyFamilyOf(const std::vector<std::string>& effects);

/// What the pressure map gains from knowing these effects, as one or two sentences; "" if there are none. A
/// calibration of the recordings is trained with and without a model of the sheet's memory, and each protocol
/// is predicted without it. `threads` as in CalibrationOptions.
std::string mapGain(const std::vector<fsr::dataset::Recording>& recordings,
                    const std::vector<std::string>& effects, unsigned threads);

}  // namespace fsr_ros
