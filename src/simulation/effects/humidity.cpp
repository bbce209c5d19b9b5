// Ink and adhesive absorb water within hours. This changes their conductance.
//
//     g = g (1 + w (H - H_0))
//
// Size: Interlink FSR 400 (data sheet PDS-10004-C): resistance +10 % after an hour at +85 degree Celsius and
// 95 % relative humidity; dry heat made it -15 %. A sealed sheet in dry gas keeps its water content.
// Measurements at two ambient humidities over days show the effect.

#include "simulation/effects/effect_library.h"

namespace fsr::simulation {

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
