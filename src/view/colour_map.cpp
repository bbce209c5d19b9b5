#include "fsr_pressure_map/view/colour_map.h"

#include <algorithm>

#include "fsr_pressure_map/settings/input_error.h"
#include "tables.h"

namespace fsr {

std::vector<std::string> colourMapNames() {
  return {"viridis", "cividis"};
}

ColourMap colourMapOf(const std::string& name) {
  if (name == "viridis") return ColourMap::kViridis;
  if (name == "cividis") return ColourMap::kCividis;
  throw InputError("colour map is \"" + name + "\", but must be viridis or cividis");
}

Colour colourAt(ColourMap map, double fraction) {
  const std::uint8_t* table = map == ColourMap::kViridis ? tables::kViridis : tables::kCividis;
  const double inside = fraction > 0 ? std::min(fraction, 1.0) : 0.0;  // NaN compares false
  const std::uint8_t* rgb = table + 3 * std::min(255, static_cast<int>(inside * 256));
  return {rgb[0], rgb[1], rgb[2]};
}

}  // namespace fsr
