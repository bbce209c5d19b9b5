#include "simulation/effects/effect_library.h"

namespace fsr::simulation {

// A soft liner or backing lets the sheet sink in. It spreads the load over the neighbours and carries part
// of it.
//
//     P_i = sum_k K(x_i - x_k) P_k
//
// Gas presses with the same pressure everywhere, so that K, whose sum is 1, changes nothing. An indenter
// pressed on the sheet with and without its liner shows the effect.

EffectEntry compliance() {
  EffectInfo info;
  info.id = "compliance";
  info.summary = "liner and backing are soft";
  info.equation = "P_i = sum_k K(x_i - x_k) P_k";
  info.source = "not simulated; shown by an indenter pressed on the sheet with and without its liner";
  info.stage = ChainStage::kLoad;
  info.level = EffectLevel::kRig;
  info.kind = EffectKind::kListed;
  info.sign = SignRule::kEither;
  info.depends_on = {Covariate::kTaxel, Covariate::kTotalLoad};
  info.collinear = {"edge_stiffness", "crosstalk"};
  info.experiment = Experiment::kIndenterAndLiner;
  return {info, nullptr};
}

// A tangential load shifts the layers against each other and strains their contacts.
//
//     P_e = P_e + s |tau|   [Pa]
//
// tau: shear stress [Pa]. A gas at rest exerts no shear. A sledge pulled over the loaded sheet shows the
// effect.

EffectEntry shear() {
  EffectInfo info;
  info.id = "shear";
  info.summary = "tangential load between skin and socket";
  info.equation = "P_e += s |tau|";
  info.source = "not simulated; shown by a weighted sledge drawn over the sheet";
  info.stage = ChainStage::kLoad;
  info.level = EffectLevel::kTaxel;
  info.kind = EffectKind::kListed;
  info.sign = SignRule::kEither;
  info.depends_on = {Covariate::kTaxel};
  info.collinear = {"bending_preload", "hysteresis"};
  info.experiment = Experiment::kIndenterAndLiner;
  return {info, nullptr};
}

// A crease of the sheet presses its layers together along a line.
//
//     P_e = P_e + P_w along the crease   [Pa]
//
// In a chamber the crease looks like a larger preload of a few taxels, and whether the next mount has it is
// random. An indenter beside and on the crease shows the effect.

EffectEntry wrinkle() {
  EffectInfo info;
  info.id = "wrinkle";
  info.summary = "a crease presses the layers together in one place";
  info.equation = "P_e += P_w along the crease";
  info.source = "not simulated; shown by an indenter beside and on the crease, and a mount without it";
  info.stage = ChainStage::kLoad;
  info.level = EffectLevel::kMount;
  info.kind = EffectKind::kListed;
  info.sign = SignRule::kEither;
  info.depends_on = {Covariate::kMount, Covariate::kTaxel, Covariate::kPressure};
  info.collinear = {"repositioning", "bending_preload"};
  info.experiment = Experiment::kIndenterAndLiner;
  return {info, nullptr};
}

// Ink and adhesive absorb water within hours. This changes their conductance.
//
//     g = g (1 + w (H - H_0))
//
// Size: Interlink FSR 400 (data sheet PDS-10004-C): resistance +10 % after an hour at +85 degree Celsius and
// 95 % relative humidity; dry heat made it -15 %. A sealed sheet in dry gas keeps its water content.
// Measurements at two ambient humidities over days show the effect.

EffectEntry humidity() {
  EffectInfo info;
  info.id = "humidity";
  info.summary = "moisture in ink and adhesive";
  info.equation = "g *= 1 + w (H - H_0)";
  info.source = "not simulated; shown by two ambient humidities over days, with a hygrometer";
  info.stage = ChainStage::kGain;
  info.level = EffectLevel::kRig;
  info.kind = EffectKind::kListed;
  info.sign = SignRule::kEither;
  info.depends_on = {Covariate::kClockTime};
  info.collinear = {"drift", "temperature"};
  info.experiment = Experiment::kTwoHumidities;
  return {info, nullptr};
}

}  // namespace fsr::simulation
