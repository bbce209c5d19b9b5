#pragma once

#include <string>
#include <vector>

#include "simulation/effect.h"

namespace fsr::simulation {

// The effects, one file each in src/simulation/effects. A new effect: its file, a line here and one in
// effectLibrary().
EffectEntry timeSkew();
EffectEntry scanSkew();
EffectEntry sealLeak();
EffectEntry trappedGas();
EffectEntry edgeStiffness();
EffectEntry repositioning();
EffectEntry bendingPreload();
EffectEntry turnOn();
EffectEntry hysteresis();
EffectEntry creep();
EffectEntry bendingGain();
EffectEntry temperature();
EffectEntry breakIn();
EffectEntry wear();
EffectEntry staticCurve();
EffectEntry deadTaxel();
EffectEntry rowFault();
EffectEntry columnFault();
EffectEntry crosstalk();
EffectEntry supplyDroop();
EffectEntry converter();
EffectEntry drift();
EffectEntry mainsPickup();
EffectEntry whiteNoise();
EffectEntry saturation();
EffectEntry stuckTaxel();
EffectEntry transducerError();
// Listed only: a gas chamber cannot show them.
EffectEntry compliance();
EffectEntry shear();
EffectEntry wrinkle();
EffectEntry humidity();

/// All effects, in the order in which they act, those last that are only listed.
const std::vector<EffectEntry>& effectLibrary();

/// The effect of that id, nullptr where there is none.
const EffectEntry* findEffect(const std::string& id);

/// The effect that a detector finds. Throws std::out_of_range where none is.
const EffectInfo& foundBy(Detector detector);

/// The ids of all effects, in the library's order.
std::vector<std::string> effectIds();

}  // namespace fsr::simulation
