// A tangential load drags the layers and tears at their contacts.
//
//     P_e = P_e + s |tau|   [Pa]
//
// Gas at rest has no shear. A sledge on the loaded sheet shows it.

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
