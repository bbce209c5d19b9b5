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

std::shared_ptr<const EffectLibrary> EffectLibrary::forRange(double range) const {
  std::vector<EffectEntry> entries = entries_;
  for (EffectEntry& entry : entries) {
    for (EffectParameter& parameter : entry.info.parameters) parameter = parameter.scaledTo(range);
  }
  return std::make_shared<EffectLibrary>(entries);
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
                                 return unwanted(libraryOf(settings).info(effect.id), effect);
                               }),
                effects.end());
  return settings;
}

}  // namespace

bool isByChance(const EffectInfo& info, const EnabledEffect& effect) {
  if (info.by_chance && effect.spells.empty()) return true;
  const std::vector<EffectParameter> steps = walks(info);
  return std::any_of(steps.begin(), steps.end(), [&](const EffectParameter& step) {
    const auto value = effect.values.find(step.name);
    return value != effect.values.end() && value->second != step.neutral;
  });
}

SimulationSettings withoutNoise(SimulationSettings settings) {
  return without(std::move(settings),
                 [](const EffectInfo& info, const EnabledEffect&) { return info.stochastic; });
}

SimulationSettings withoutChance(SimulationSettings settings) {
  settings = without(std::move(settings), [](const EffectInfo& info, const EnabledEffect& effect) {
    return info.stochastic || (info.by_chance && effect.spells.empty());
  });
  for (EnabledEffect& effect : settings.effects) {
    for (const EffectParameter& step : walks(libraryOf(settings).info(effect.id)))
      effect.values[step.name] = step.neutral;
  }
  return settings;
}

// A soft liner or backing lets the sheet sink in. It spreads the load over the neighbours and carries part
// of it.
//
//     P_i = sum_k K(x_i - x_k) P_k
//
// Gas presses with the same pressure everywhere, so that K, whose sum is 1, changes nothing. An indenter
// pressed on the sheet with and without its liner shows the effect.

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

// A tangential load shifts the layers against each other and strains their contacts.
//
//     P_e = P_e + s |tau|   [Pa]
//
// tau: shear stress [Pa]. A gas at rest exerts no shear. A sledge pulled over the loaded sheet shows the
// effect.

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

// A crease of the sheet presses its layers together along a line.
//
//     P_e = P_e + P_w along the crease   [Pa]
//
// In a chamber the crease looks like a larger preload of a few taxels, and whether the next mount has it is
// random. An indenter beside and on the crease shows the effect.

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

// Ink and adhesive absorb water within hours. This changes their conductance.
//
//     g = g (1 + w (H - H_0))
//
// Size: Interlink FSR 400 (data sheet PDS-10004-C): resistance +10 % after an hour at +85 degree Celsius and
// 95 % relative humidity; dry heat made it -15 %. A sealed sheet in dry gas keeps its water content.
// Measurements at two ambient humidities over days show the effect.

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
