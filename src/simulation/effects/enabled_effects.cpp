#include "simulation/effects/enabled_effects.h"

#include <algorithm>

#include "simulation/effects/effect_library.h"

namespace fsr::simulation {

bool isNoise(const EnabledEffect& effect) {
  return findEffect(effect.id)->info.stochastic;
}

bool isConverter(const EnabledEffect& effect) {
  const EffectInfo& info = findEffect(effect.id)->info;
  return info.required && info.stage == ChainStage::kSample;
}

SimulationSettings withoutNoise(SimulationSettings settings) {
  auto& effects = settings.effects;
  effects.erase(std::remove_if(effects.begin(), effects.end(), isNoise), effects.end());
  return settings;
}

}  // namespace fsr::simulation
