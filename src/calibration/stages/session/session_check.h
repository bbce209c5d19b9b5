#pragma once

#include <vector>

#include "fsr_pressure_map/calibration/calibration.h"

namespace fsr::calibration {

/// The offset of each taxel that a tare at the start of a session measures [Pa]: what a live map without tare
/// and memory shows too much over restAtStart(), beyond what it showed so at the rests of the training. Empty
/// where the calibration expects no tare or the session does not start with a rest. `condition`: of the
/// recording.
std::vector<float> tareAtStart(const Calibration& calibration, const dataset::Recording& recording,
                               std::size_t condition);

}  // namespace fsr::calibration
