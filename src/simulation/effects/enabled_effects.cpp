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

namespace {

template <typename Unwanted>
SimulationSettings without(SimulationSettings settings, Unwanted unwanted) {
  auto& effects = settings.effects;
  effects.erase(std::remove_if(effects.begin(), effects.end(),
                               [&](const EnabledEffect& effect) {
                                 return unwanted(libraryOf(settings).info(effect.id));
                               }),
                effects.end());
  return settings;
}

}  // namespace

SimulationSettings withoutNoise(SimulationSettings settings) {
  return without(std::move(settings), [](const EffectInfo& info) { return info.stochastic; });
}

SimulationSettings withoutChance(SimulationSettings settings) {
  settings =
      without(std::move(settings), [](const EffectInfo& info) { return info.stochastic || info.by_chance; });
  for (EnabledEffect& effect : settings.effects) {
    for (const EffectParameter& step : walks(libraryOf(settings).info(effect.id)))
      effect.values[step.name] = step.neutral;
  }
  return settings;
}

}  // namespace fsr::simulation
