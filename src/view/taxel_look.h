#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fsr_pressure_map/map/pressure_map.h"
#include "fsr_pressure_map/matrix/layout.h"
#include "fsr_pressure_map/view/colour_map.h"

namespace fsr::view {

/// How reliable a taxel's colour is. All but kGood and kBelowRange have a mark, which is the same in pictures
/// and meshes and does not depend on colour.
enum class TaxelLook {
  kGood,
  kBelowRange,    ///< "less than": below the turn-on pressure, as every taxel at rest
  kExtrapolated,  ///< reading, curvature or temperature outside the range of training
  kSaturated,     ///< "at least": the converter is at full scale
  kNoReading,     ///< dead, stuck, masked or uncalibrated
};

/// The first that applies: no reading, saturated, below range (if the curvature is not extrapolated),
/// extrapolated, good. A taxel that was filled from its neighbours has a colour and the mark for no reading.
TaxelLook lookOf(float pressure, std::uint16_t flags);

/// All looks that have a mark, and their names in legends.
const std::vector<TaxelLook>& markedLooks();
std::string name(TaxelLook look);

/// What pictures and panels say while part of the taxels (0 to 1, see map::unsettledShare()) is not settled.
/// These taxels have no mark, because after each start it would be on all of them. The word fits a legend,
/// e.g. "settling: 12 % of taxels"; the text is e.g. "history not settled on 12 % of taxels".
/// Both are empty at 0.
std::string settlingWord(double share);
std::string settlingText(double share);

/// A straight line within a taxel's square: coordinates from -0.5 to 0.5 along the row (x) and the column
/// (y).
struct Stroke {
  matrix::Position from;
  matrix::Position to;
};

/// The mark of a look: cross = no reading, open square = saturated, two diagonals = extrapolated,
/// nothing = good or below range.
const std::vector<Stroke>& mark(TaxelLook look);

/// Colour of a taxel without a pressure: a grey that is in no colour map.
constexpr Colour kNoReadingColour{128, 128, 128};
/// Colour of marks on a square of colour `under`: white or black, by contrast.
Colour markColour(Colour under);

}  // namespace fsr::view
