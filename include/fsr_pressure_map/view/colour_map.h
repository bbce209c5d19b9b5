#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "fsr_pressure_map/settings/pressure_unit.h"

namespace fsr::view {

/// A colour in sRGB.
struct Colour {
  std::uint8_t red = 0;
  std::uint8_t green = 0;
  std::uint8_t blue = 0;
};

inline bool operator==(Colour a, Colour b) {
  return a.red == b.red && a.green == b.green && a.blue == b.blue;
}

/// Colour maps with equal perceived steps, from dark to bright. Their order is the same for people with a
/// colour vision deficiency and on a grey printer. Cividis is made for red-green deficiency; viridis has more
/// hues.
enum class ColourMap { kViridis, kCividis };

/// The names in parameters: viridis, cividis.
std::vector<std::string> colourMapNames();
/// Throws InputError for a name that is not among colourMapNames().
ColourMap colourMapOf(const std::string& name);

/// The map's colours [256 x 3]: steps from dark to bright; red, green, blue.
const std::uint8_t* colourTable(ColourMap map);

/// Colour at `fraction` of the scale, one of 256 steps. Fractions below 0 and above 1 give the end colours,
/// NaN the colour of 0.
Colour colourAt(ColourMap map, double fraction);
/// The same with a table of colourTable(): faster for many pixels.
inline Colour colourAt(const std::uint8_t* table, double fraction) {
  const double inside = fraction > 0 ? std::min(fraction, 1.0) : 0.0;  // NaN compares false
  const std::uint8_t* rgb = table + 3 * std::min(255, static_cast<int>(inside * 256));
  return {rgb[0], rgb[1], rgb[2]};
}

using settings::name;
using settings::pascals;
using settings::PressureUnit;
using settings::pressureUnitNames;
using settings::pressureUnitOf;

/// Assigns colours to pressures, with the unit for the legend.
struct PressureScale {
  double low = 0;       ///< [Pa]
  double high = 600e3;  ///< [Pa]
  PressureUnit unit = PressureUnit::kKilopascal;
  ColourMap colours = ColourMap::kViridis;

  Colour colour(double pressure) const { return colourAt(colours, (pressure - low) / (high - low)); }
};

/// Throws InputError unless low and high are finite and low < high.
void requireSound(const PressureScale& scale);

/// A pressure [Pa] as text in a unit, e.g. "312 kPa". NaN and infinity give "-".
std::string pressureText(double pressure, PressureUnit unit);
/// The same with ">= " in front where the pressure is a lower limit.
std::string limitText(double pressure, PressureUnit unit, bool at_least);

/// A tick of a colour bar.
struct Tick {
  double pressure = 0;  ///< [Pa]
  std::string label;    ///< number in the scale's unit
};

/// Round values inside the scale, at most `most` of them. Their distance is 1, 2 or 5 times a power of ten.
std::vector<Tick> ticks(const PressureScale& scale, int most);

}  // namespace fsr::view
