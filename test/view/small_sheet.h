#pragma once

#include "fsr_pressure_map/matrix/curvature.h"
#include "fsr_pressure_map/matrix/layout.h"

namespace fsr::view {

const matrix::Layout kLayout{{7, 10}, 0.010, 0.012};

inline matrix::Surface uniform(const matrix::Curvature& curvature) {
  matrix::Surface surface;
  surface.curvature = {curvature};
  return surface;
}

}  // namespace fsr::view
