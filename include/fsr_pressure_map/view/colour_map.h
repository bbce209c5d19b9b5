#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

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

}  // namespace fsr::view
