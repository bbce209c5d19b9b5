#include "simulation/effects/effect_library.h"

#include <algorithm>
#include <stdexcept>

#include "fsr_pressure_map/settings/input_error.h"

namespace fsr::simulation {

const EffectLibrary& EffectLibrary::shipped() {
  static const EffectLibrary library(std::vector<EffectEntry>{
      timeSkew(),       scanSkew(),   sealLeak(),    trappedGas(),  edgeStiffness(),   repositioning(),
      bendingPreload(), turnOn(),     hysteresis(),  creep(),       relaxation(),      bendingGain(),
      temperature(),    breakIn(),    wear(),        staticCurve(), deadTaxel(),       rowFault(),
      columnFault(),    crosstalk(),  supplyDroop(), converter(),   drift(),           mainsPickup(),
      sessionOffset(),  whiteNoise(), saturation(),  stuckTaxel(),  transducerError(), compliance(),
      shear(),          wrinkle(),    humidity(),
  });
  return library;
}

std::shared_ptr<const EffectLibrary> EffectLibrary::with(EffectEntry entry) const {
  if (find(entry.info.id))
    throw settings::InputError(entry.info.id + ": there is an effect of that name already");
  std::vector<EffectEntry> entries = entries_;
  entries.push_back(std::move(entry));
  return std::make_shared<const EffectLibrary>(std::move(entries));
}

const EffectEntry* EffectLibrary::find(const std::string& id) const {
  const auto found = std::find_if(entries_.begin(), entries_.end(),
                                  [&](const EffectEntry& entry) { return entry.info.id == id; });
  return found == entries_.end() ? nullptr : &*found;
}

const EffectInfo& EffectLibrary::info(const std::string& id) const {
  if (const EffectEntry* entry = find(id)) return entry->info;
  throw std::out_of_range("no effect is called " + id);
}

const EffectInfo& EffectLibrary::foundBy(Detector detector) const {
  for (const EffectEntry& entry : entries_) {
    if (entry.info.detector == detector) return entry.info;
  }
  throw std::out_of_range("no effect of the library is found by that detector");
}

std::vector<std::string> EffectLibrary::ids() const {
  std::vector<std::string> ids;
  for (const EffectEntry& entry : entries_) ids.push_back(entry.info.id);
  return ids;
}

const EffectLibrary& libraryOf(const SimulationSettings& settings) {
  return settings.library ? *settings.library : EffectLibrary::shipped();
}

const std::vector<EffectEntry>& effectLibrary() {
  return EffectLibrary::shipped().entries();
}

const EffectEntry* findEffect(const std::string& id) {
  return EffectLibrary::shipped().find(id);
}

const EffectInfo& foundBy(Detector detector) {
  return EffectLibrary::shipped().foundBy(detector);
}

std::vector<std::string> effectIds() {
  return EffectLibrary::shipped().ids();
}

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
