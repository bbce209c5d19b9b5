#pragma once

#include <string>
#include <vector>

#include "fsr_pressure_map/view/colour_map.h"

namespace fsr::view {

/// Units for display; all other interfaces use Pa. kCount is for pictures of raw scans, which are not
/// pressures.
enum class PressureUnit { kKilopascal, kMillimetreOfMercury, kCount };

std::vector<std::string> pressureUnitNames();  ///< kPa, mmHg
/// Throws InputError for a name that is not among pressureUnitNames().
PressureUnit pressureUnitOf(const std::string& name);
std::string name(PressureUnit unit);
/// Size of one unit [Pa]. The conventional mmHg is 133.322387415 Pa (ISO 80000-4:2006). For kCount it is 1:
/// such a scale contains counts.
double pascals(PressureUnit unit);

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

/// A tick of a colour bar.
struct Tick {
  double pressure = 0;  ///< [Pa]
  std::string label;    ///< number in the scale's unit
};

/// Round values inside the scale, at most `most` of them. Their distance is 1, 2 or 5 times a power of ten.
std::vector<Tick> ticks(const PressureScale& scale, int most);

}  // namespace fsr::view
