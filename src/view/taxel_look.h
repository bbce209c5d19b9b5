#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fsr_pressure_map/map/pressure_map.h"
#include "fsr_pressure_map/matrix/layout.h"
#include "fsr_pressure_map/view/colour_map.h"

namespace fsr::view {

/// How much a taxel's colour may be believed. Told by shape, not by hue: each look but the first has a
/// mark of its own, which pictures and meshes draw alike.
enum class TaxelLook {
  kGood,
  kBelowRange,    ///< "less than": under the turn-on pressure
  kExtrapolated,  ///< reading, curvature or temperature beyond those of training
  kSaturated,     ///< "at least": the converter is at its end
  kNoReading,     ///< dead, stuck, masked or uncalibrated
};

/// The worst that holds: no reading, saturated, extrapolated, below range, good. A taxel that was filled from
/// its neighbours has a colour, and the mark of one without a reading.
TaxelLook lookOf(float pressure, std::uint16_t flags);

/// All looks that have a mark, and what a legend calls them.
const std::vector<TaxelLook>& markedLooks();
std::string name(TaxelLook look);

/// A straight line within a taxel's square; -0.5 .. 0.5 along the row (x) and the column (y).
struct Stroke {
  matrix::Position from;
  matrix::Position to;
};

/// The look's mark: cross = no reading, open square = saturated, two diagonals = extrapolated, a dash =
/// below range; none = good.
const std::vector<Stroke>& mark(TaxelLook look);

/// Colour of a taxel without a pressure: a grey that no colour map has.
constexpr Colour kNoReadingColour{128, 128, 128};
/// Colour of marks on a square of colour `under`: white or black, whichever stands out.
Colour markColour(Colour under);

}  // namespace fsr::view
