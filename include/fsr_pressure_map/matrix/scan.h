#pragma once

#include <cstdint>
#include <vector>

#include "fsr_pressure_map/matrix/layout.h"

namespace fsr {

/// One reading of every taxel, as the converter gave it.
struct Scan {
  MatrixSize size;
  std::uint16_t full_scale = 0;       ///< largest count that the converter can give, e.g. 4095
  std::vector<std::uint16_t> counts;  ///< [rows x columns], row-major
};

}  // namespace fsr
