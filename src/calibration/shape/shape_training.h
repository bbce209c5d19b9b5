#pragma once

#include <vector>

#include "calibration/session/session_rests.h"
#include "fsr_pressure_map/calibration/calibration.h"
#include "fsr_pressure_map/dataset/recording.h"

namespace fsr::calibration {

/// Gives the calibration its model of the shape, and a warning for each misplaced mount.
/// `threads`: 0 = one for each core.
void trainShape(const std::vector<dataset::Recording>& recordings, const Sessions& sessions, unsigned threads,
                Calibration& calibration);

}  // namespace fsr::calibration
