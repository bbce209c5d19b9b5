#pragma once

#include <fsr_pressure_map/SurfaceCurvature.h>

#include "fsr_pressure_map/matrix/curvature.h"

namespace fsr_ros {

/// The message's surface, or InputError where its arrays do not fit each other: each of x, y, xy
/// and deviation may be empty, one value, or one value for each taxel.
fsr::matrix::Surface toSurface(const fsr_pressure_map::SurfaceCurvature& message);

/// Header left empty.
fsr_pressure_map::SurfaceCurvature toMessage(const fsr::matrix::Surface& surface);

}  // namespace fsr_ros
