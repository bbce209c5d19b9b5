#pragma once

#include <vector>

#include "calibration/shape/mounted_rests.h"
#include "fsr_pressure_map/calibration/calibration.h"
#include "fsr_pressure_map/compensation/shape.h"

namespace fsr::calibration {

/// Learns how the sheet reads at rest on each surface, see compensation::ShapeModel. `calibration` must have
/// its tables. Where nothing can be learnt, the model says why. `errors_between`: also the errors between
/// surfaces, which take the longest; without, they are not known.
compensation::ShapeModel learnShape(const std::vector<MountedRest>& mounts, const Calibration& calibration,
                                    bool errors_between = true);

/// Whether the surface is known and has one curvature all over.
bool bentAlike(const matrix::Surface& surface);

}  // namespace fsr::calibration
