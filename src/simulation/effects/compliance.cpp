// A soft liner or backing lets the sheet sink in, spreads what presses on it and shares the load.
//
//     P_i = sum_k K(x_i - x_k) P_k
//
// Gas presses the same everywhere and on both: K, whose sum is 1, changes nothing. An indenter on a liner
// shows it.

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
