#include "map/hold_peaks.h"

#include <cmath>

namespace fsr::map {

void holdPeaks(const PressureMap& map, PressureMap& peaks) {
  if (peaks.layout.size != map.layout.size || peaks.pressure.size() != map.pressure.size()) {
    peaks = map;
    return;
  }
  peaks.state = map.state;
  for (std::size_t i = 0; i < map.pressure.size(); ++i) {
    if (!(map.pressure[i] > peaks.pressure[i]) && !std::isnan(peaks.pressure[i])) continue;
    peaks.pressure[i] = map.pressure[i];
    peaks.deviation[i] = map.deviation[i];
    peaks.flags[i] = map.flags[i];
  }
}

}  // namespace fsr::map
