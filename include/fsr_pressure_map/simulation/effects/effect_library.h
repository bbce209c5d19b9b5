#pragma once

#include <string>
#include <vector>

#include "fsr_pressure_map/simulation/effect.h"

namespace fsr {

/// The effects, one file each in src/simulation/effects. A new effect: its file, a line here and one
/// in effectLibrary().
EffectEntry bendingPreload();
EffectEntry hysteresis();
EffectEntry bendingGain();
EffectEntry staticCurve();
EffectEntry converter();
EffectEntry whiteNoise();

/// All effects, in the order in which they act.
const std::vector<EffectEntry>& effectLibrary();

/// The effect of that id, nullptr where there is none.
const EffectEntry* findEffect(const std::string& id);

/// The ids of all effects, in the library's order.
std::vector<std::string> effectIds();

}  // namespace fsr
