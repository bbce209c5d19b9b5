// A crease of the sheet presses its layers together along a line.
//
//     P_e = P_e + P_w along the crease   [Pa]
//
// In a chamber the crease looks like a larger preload of a few taxels, and whether the next mount has it is
// random. An indenter beside and on the crease shows the effect.

#include "simulation/effects/effect_library.h"

namespace fsr::simulation {

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

}  // namespace fsr::simulation
