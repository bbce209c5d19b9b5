#include "fsr_pressure_map/map/pressure_map.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fsr::map {

bool hasReading(float pressure, std::uint16_t flags) {
  using namespace taxel_flag;
  return !std::isnan(pressure) && (flags & (kDead | kStuck | kMasked | kLineFault)) == 0;
}

double unsettledShare(const std::vector<float>& pressure, const std::vector<std::uint16_t>& flags) {
  std::size_t readings = 0, unsettled = 0;
  for (std::size_t i = 0; i < std::min(pressure.size(), flags.size()); ++i) {
    if (!hasReading(pressure[i], flags[i])) continue;
    ++readings;
    unsettled += (flags[i] & taxel_flag::kHistoryShort) != 0;
  }
  return readings == 0 ? 0 : double(unsettled) / double(readings);
}

void PressureMap::reset(const matrix::Layout& new_layout) {
  layout = new_layout;
  const std::size_t n = layout.size.taxels();
  pressure.assign(n, std::numeric_limits<float>::quiet_NaN());
  deviation.assign(n, std::numeric_limits<float>::quiet_NaN());
  flags.assign(n, 0);
}

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
