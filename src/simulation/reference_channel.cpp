#include "simulation/reference_channel.h"

#include "simulation/effects/effect_library.h"

namespace fsr::simulation {

ReferenceChannel::ReferenceChannel(const SimulationSettings& settings) : transducer_(settings.transducer) {
  for (const EnabledEffect& enabled : settings.effects) {
    const EffectEntry* entry = libraryOf(settings).find(enabled.id);
    if (entry->info.stage != ChainStage::kReference) continue;
    effects_.push_back(entry->make(enabled.values, {settings.layout, settings.seed}));
  }
}

double ReferenceChannel::indicated(double pressure) const {
  for (const auto& effect : effects_) pressure = effect->transduce(pressure);
  return pressure;
}

double ReferenceChannel::truePressure(double indicated) const {
  // Errors are a fraction of the pressure, so that each round leaves a fraction of the rest.
  constexpr int kMostRounds = 40;
  double pressure = indicated;
  for (int round = 0; round < kMostRounds; ++round) {
    const double rest = indicated - this->indicated(pressure);
    if (rest == 0) break;
    pressure += rest;
  }
  return pressure;
}

}  // namespace fsr::simulation
