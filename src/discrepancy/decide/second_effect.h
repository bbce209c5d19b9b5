#pragma once

#include <vector>

#include "discrepancy/decide/comparison.h"
#include "simulation/effects/effect_library.h"

namespace fsr::discrepancy {

/// Pairs of effects in which the second effect explains enough of the residual of `one`, the best single
/// effect. The best pair is first. Raises the explainable share of `comparison` to the share of the best
/// pair. A pair with drift comes first only where no other pair adds half as much, because every slow effect
/// looks like drift. The same holds for a pair with a strength that is not plausible.
std::vector<Explanation> pairsWorthIt(Comparison& comparison, const Explanation& one);

/// Whether the single effect stays credible beside the pair. For example, a loop with a break-in has the same
/// traces as a creep whose form is not in the library.
bool mayBeOne(const Explanation& single, const Explanation& pair,
              const simulation::EffectLibrary& library = simulation::EffectLibrary::shipped());

}  // namespace fsr::discrepancy
