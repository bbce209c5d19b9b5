#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

namespace fsr::view {

/// A colour as screens take it (sRGB).
struct Colour {
  std::uint8_t red = 0;
  std::uint8_t green = 0;
  std::uint8_t blue = 0;
};

inline bool operator==(Colour a, Colour b) {
  return a.red == b.red && a.green == b.green && a.blue == b.blue;
}

/// Colour maps of even perceived steps, dark to bright, that people with a colour vision deficiency and
/// grey printers order alike. Cividis is made for red-green deficiency, viridis has more hues.
enum class ColourMap { kViridis, kCividis };

/// The map's name in parameters: viridis, cividis.
std::vector<std::string> colourMapNames();
/// Throws InputError for a name that colourMapNames() does not have.
ColourMap colourMapOf(const std::string& name);

/// Its 256 steps, dark to bright, red, green, blue one after another.
const std::uint8_t* colourTable(ColourMap map);

/// Colour at `fraction` of the scale, ends beyond 0 and 1, one of 256 steps. NaN is no fraction: 0.
Colour colourAt(ColourMap map, double fraction);
/// The same from colourTable(), for every pixel of a picture.
inline Colour colourAt(const std::uint8_t* table, double fraction) {
  const double inside = fraction > 0 ? std::min(fraction, 1.0) : 0.0;  // NaN compares false
  const std::uint8_t* rgb = table + 3 * std::min(255, static_cast<int>(inside * 256));
  return {rgb[0], rgb[1], rgb[2]};
}

}  // namespace fsr::view
