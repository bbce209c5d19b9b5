#include "fsr_pressure_map/view/colour_map.h"

#include <algorithm>
#include <cmath>

#include "fsr_pressure_map/settings/input_error.h"
#include "settings/number_text.h"
#include "view/tables.h"

namespace fsr::view {

namespace {

std::string number(double value, int decimals) {
  return settings::fixedText(value == 0 ? 0.0 : value, decimals);  // avoids "-0"
}

// Smallest value of 1, 2 or 5 x 10^n that is not below `least`.
double roundStep(double least) {
  const double power = std::pow(10.0, std::floor(std::log10(least)));
  for (const double digit : {1.0, 2.0, 5.0}) {
    if (digit * power >= least * (1 - 1e-9)) return digit * power;
  }
  return 10 * power;
}

}  // namespace

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

void requireSound(const PressureScale& scale) {
  if (std::isfinite(scale.low) && std::isfinite(scale.high) && scale.low < scale.high) return;
  throw settings::InputError("the scale runs from " + pressureText(scale.low, scale.unit) + " to " +
                             pressureText(scale.high, scale.unit) +
                             ", but its upper end must be above its lower end");
}

std::string pressureText(double pressure, PressureUnit unit) {
  if (!std::isfinite(pressure)) return "-";
  const double value = pressure / pascals(unit);
  return number(std::abs(value) < 9.95 ? std::round(value * 10) / 10 : std::round(value),
                std::abs(value) < 9.95 ? 1 : 0) +
         " " + name(unit);
}

std::string limitText(double pressure, PressureUnit unit, bool at_least) {
  return (at_least && std::isfinite(pressure) ? ">= " : "") + pressureText(pressure, unit);
}

std::vector<Tick> ticks(const PressureScale& scale, int most) {
  const double unit = pascals(scale.unit);
  const double low = scale.low / unit;
  const double high = scale.high / unit;
  const double step = roundStep((high - low) / std::max(1, most - 1));
  const int decimals = std::max(0, static_cast<int>(-std::floor(std::log10(step) + 1e-9)));
  std::vector<Tick> result;
  const double slack = 1e-9 * step;
  for (double n = std::ceil((low - slack) / step); n * step <= high + slack; ++n) {
    result.push_back({n * step * unit, number(n * step, decimals)});
  }
  return result;
}

}  // namespace fsr::view
