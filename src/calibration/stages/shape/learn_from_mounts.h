#pragma once

#include <vector>

#include "calibration/stages/session/session_rests.h"
#include "calibration/stages/shape/mounted_rests.h"
#include "fsr_pressure_map/calibration/calibration.h"
#include "fsr_pressure_map/calibration/shape.h"
#include "fsr_pressure_map/dataset/recording.h"

namespace fsr::calibration {

/// Learns how the sheet reads at rest on each surface, see ShapeModel. `calibration` must have
/// its tables. Where nothing can be learnt, the model says why. `errors_between`: also the errors between
/// surfaces, which take the longest; without, they are not known.
ShapeModel learnShape(const std::vector<MountedRest>& mounts, const Calibration& calibration,
                      bool errors_between = true);

/// Whether the surface is known and has one curvature all over.
bool bentAlike(const matrix::Surface& surface);

/// Gives the calibration its model of the shape, and a warning for each misplaced mount.
/// `threads`: 0 = one for each core.
void trainShape(const std::vector<dataset::Recording>& recordings, const Sessions& sessions, unsigned threads,
                Calibration& calibration);

}  // namespace fsr::calibration
