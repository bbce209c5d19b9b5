#pragma once

#include <fsr_pressure_map/SurfaceCurvature.h>

#include "fsr_pressure_map/matrix/curvature.h"

namespace fsr_ros {

/// The surface of a message. Each of x, y, xy and deviation may be empty, have one value, or have one value
/// for each taxel. Throws fsr::InputError if the arrays do not fit each other or hold a value that is not
/// finite.
fsr::matrix::Surface toSurface(const fsr_pressure_map::SurfaceCurvature& message);

/// The message of a surface, without header.
fsr_pressure_map::SurfaceCurvature toMessage(const fsr::matrix::Surface& surface);

}  // namespace fsr_ros
