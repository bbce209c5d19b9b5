// A soft liner or backing lets the sheet sink in. It spreads the load over the neighbours and carries part
// of it.
//
//     P_i = sum_k K(x_i - x_k) P_k
//
// Gas presses with the same pressure everywhere, so that K, whose sum is 1, changes nothing. An indenter
// pressed on the sheet with and without its liner shows the effect.

#include "simulation/effects/effect_library.h"

namespace fsr::simulation {

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

}  // namespace fsr::simulation
