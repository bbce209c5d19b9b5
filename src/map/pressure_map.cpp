#include "fsr_pressure_map/map/pressure_map.h"

#include <limits>

namespace fsr::map {

void PressureMap::reset(const matrix::Layout& new_layout) {
  layout = new_layout;
  const std::size_t n = layout.size.taxels();
  pressure.assign(n, std::numeric_limits<float>::quiet_NaN());
  deviation.assign(n, std::numeric_limits<float>::quiet_NaN());
  flags.assign(n, 0);
}

}  // namespace fsr::map
