#pragma once

#include <string>
#include <vector>

#include "fsr_pressure_map/view/colour_map.h"

namespace fsr::view {

/// Units of screens; everything else is in Pa. Only a picture of raw scans has counts, which are no pressure.
enum class PressureUnit { kKilopascal, kMillimetreOfMercury, kCount };

std::vector<std::string> pressureUnitNames();  ///< kPa, mmHg
/// Throws InputError for a name that pressureUnitNames() does not have.
PressureUnit pressureUnitOf(const std::string& name);
std::string name(PressureUnit unit);
/// One unit [Pa]; the conventional mmHg is 133.322387415 Pa (ISO 80000-4:2006). A scale of counts holds
/// counts.
double pascals(PressureUnit unit);

/// From pressure to colour, and what a legend says about it.
struct PressureScale {
  double low = 0;       ///< [Pa]
  double high = 600e3;  ///< [Pa]
  PressureUnit unit = PressureUnit::kKilopascal;
  ColourMap colours = ColourMap::kViridis;

  Colour colour(double pressure) const { return colourAt(colours, (pressure - low) / (high - low)); }
};

/// Throws InputError unless low < high, both finite.
void requireSound(const PressureScale& scale);

/// A pressure [Pa] in the scale's unit, e.g. "312 kPa", "-"; NaN is "-".
std::string pressureText(double pressure, PressureUnit unit);

/// A mark at a colour bar.
struct Tick {
  double pressure = 0;  ///< [Pa]
  std::string label;    ///< number in the scale's unit
};

/// Round values inside the scale, at most `most` of them, a step of 1, 2 or 5 times a power of ten apart.
std::vector<Tick> ticks(const PressureScale& scale, int most);

}  // namespace fsr::view
