#include "fsr_pressure_map/view/colour_map.h"

#include "fsr_pressure_map/settings/input_error.h"
#include "view/tables.h"

namespace fsr::view {

std::vector<std::string> colourMapNames() {
  return {"viridis", "cividis"};
}

ColourMap colourMapOf(const std::string& name) {
  if (name == "viridis") return ColourMap::kViridis;
  if (name == "cividis") return ColourMap::kCividis;
  throw settings::InputError("colour map is \"" + name + "\", but must be viridis or cividis");
}

const std::uint8_t* colourTable(ColourMap map) {
  return map == ColourMap::kViridis ? tables::kViridis : tables::kCividis;
}

Colour colourAt(ColourMap map, double fraction) {
  return colourAt(colourTable(map), fraction);
}

}  // namespace fsr::view
