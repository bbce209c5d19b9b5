#pragma once

#include <vector>

#include "fsr_pressure_map/calibration/calibration.h"

namespace fsr::calibration {

/// Errors of live maps on new recordings, of the static answer and with the model of the sheet's memory,
/// which `calibration` must have. See CalibrationCheck::history.
std::vector<HistoryScore::Part> checkHistory(const Calibration& calibration,
                                             const std::vector<dataset::Recording>& recordings);

}  // namespace fsr::calibration
