#include "simulation/effects/enabled_effects.h"

#include <algorithm>

#include "simulation/effects/effect_library.h"

namespace fsr::simulation {

const EnabledEffect& converterOf(const SimulationSettings& settings) {
  return *std::find_if(settings.effects.begin(), settings.effects.end(), [&](const EnabledEffect& effect) {
    const EffectInfo& info = libraryOf(settings).info(effect.id);
    return info.required && info.stage == ChainStage::kSample;
  });
}

SimulationSettings withoutNoise(SimulationSettings settings) {
  auto& effects = settings.effects;
  const auto noise = [&](const EnabledEffect& effect) {
    return libraryOf(settings).info(effect.id).stochastic;
  };
  effects.erase(std::remove_if(effects.begin(), effects.end(), noise), effects.end());
  return settings;
}

}  // namespace fsr::simulation
