// A tangential load shifts the layers against each other and strains their contacts.
//
//     P_e = P_e + s |tau|   [Pa]
//
// tau: shear stress [Pa]. A gas at rest exerts no shear. A sledge pulled over the loaded sheet shows the
// effect.

#include "simulation/effects/effect_library.h"

namespace fsr::simulation {

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

}  // namespace fsr::simulation
