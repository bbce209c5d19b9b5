#pragma once

#include <vector>

#include "discrepancy/decide/comparison.h"
#include "simulation/effects/effect_library.h"

namespace fsr::discrepancy {

/// Two effects, where the second closes enough of what `one`, the best single effect, leaves: best first.
/// Raises the contest's explainable share to what the best of them explain. A pair with drift, which
/// everything slow looks like, or beyond what is plausible, comes first only where no other pair adds half as
/// much.
std::vector<Explanation> pairsWorthIt(Comparison& comparison, const Explanation& one);

/// Whether the single effect stays beside the pair as what it may be instead: a loop with a break-in does
/// what a creep in a form that the library lacks does.
bool mayBeOne(const Explanation& single, const Explanation& pair,
              const simulation::EffectLibrary& library = simulation::EffectLibrary::shipped());

}  // namespace fsr::discrepancy
