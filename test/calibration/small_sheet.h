#pragma once

#include "fsr_pressure_map/matrix/curvature.h"
#include "fsr_pressure_map/matrix/layout.h"

namespace fsr::calibration {

constexpr matrix::MatrixSize kSize{3, 4};
constexpr std::uint16_t kFullScale = 1023;

inline matrix::Surface bent(double curvature, const std::string& name = "surface", std::uint32_t mount = 1) {
  return {name, mount, {{curvature, 0, 0}}, {}};
}

}  // namespace fsr::calibration
