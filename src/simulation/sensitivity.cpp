#include "simulation/sensitivity.h"

#include <algorithm>
#include <cmath>

#include "fsr_pressure_map/settings/input_error.h"
#include "simulation/effects/effect_library.h"

namespace fsr::simulation {

namespace {

// Steps as shares of the usual strength. The error of a forward difference is proportional to the step, that
// of a central one to its square. The rounding error (1e-16 of the reading) is inversely proportional to the
// step.
constexpr double kForwardStep = 1e-6;
constexpr double kCentralStep = 1e-4;

const EffectInfo& knownEffect(const EffectLibrary& library, const std::string& id,
                              const std::string& strength) {
  const EffectEntry* entry = library.find(id);
  if (!entry || !entry->make) throw settings::InputError("no effect that can be simulated is called " + id);
  for (const EffectParameter& parameter : strengths(entry->info)) {
    if (parameter.name == strength) return entry->info;
  }
  throw settings::InputError("the effect " + id + " has no strength " + strength);
}

EffectValues valuesAt(const SimulationSettings& settings, const EffectInfo& info,
                      const EffectValues& overruling) {
  const EnabledEffect* enabled = settings.effect(info.id);
  EffectValues values = overruling;
  for (const EffectParameter& parameter : info.parameters) {
    const bool shape = parameter.role == ParameterRole::kShape;
    const double given = shape ? parameter.usual : parameter.neutral;
    values.emplace(parameter.name, enabled ? enabled->values.at(parameter.name) : given);
  }
  return values;
}

double scaleOf(const EffectParameter& strength) {
  return strength.usual != 0 ? std::abs(strength.usual) : 0.1 * strength.plausible.high;
}

SimulationSettings with(SimulationSettings settings, const std::string& id, const EffectValues& values) {
  settings = withoutNoise(settings);
  auto& effects = settings.effects;
  const auto unwanted = [&](const EnabledEffect& e) { return e.id == id; };
  effects.erase(std::remove_if(effects.begin(), effects.end(), unwanted), effects.end());
  effects.push_back({id, values});
  return settings;
}

void difference(const std::vector<double>& upper, const std::vector<double>& lower, double step,
                std::vector<double>& result) {
  for (std::size_t i = 0; i < result.size(); ++i) result[i] = (upper[i] - lower[i]) / step;
}

}  // namespace

Sensitivity::Side::Side(const SimulationSettings& settings) : chain(settings), reference(settings) {
  course = [this](double time) { return reference.truePressure((*recorded)(time)); };
}

const TaxelSignals& Sensitivity::Side::read(const RigSample& sample) {
  RigSample true_sample = sample;
  true_sample.pressure = reference.truePressure(sample.pressure);
  recorded = sample.course;
  true_sample.course = recorded ? &course : nullptr;
  chain.read(true_sample);
  return chain.signals();
}

Sensitivity::Sensitivity(const SimulationSettings& settings, const std::string& effect,
                         const std::string& strength, const EffectValues& values, double step) {
  const EffectInfo& info = knownEffect(libraryOf(settings), effect, strength);
  const EffectParameter& varied = parameter(info, strength);
  EffectValues at = valuesAt(settings, info, values);
  const double centre = at.at(strength);
  const double wide = scaleOf(varied) * (step > 0 ? step : kCentralStep);
  const bool forward = centre - wide < varied.permitted.low;
  const double low = forward ? centre : centre - wide;
  const double high = centre + (forward && step == 0 ? scaleOf(varied) * kForwardStep : wide);
  at[strength] = low;
  lower_ = std::make_unique<Side>(with(settings, effect, at));
  at[strength] = high;
  upper_ = std::make_unique<Side>(with(settings, effect, at));
  step_ = high - low;
  derivative_ = lower_->chain.signals();
}

void Sensitivity::mount(const matrix::Surface& surface, const LoadPattern& pattern) {
  lower_->chain.mount(surface, pattern);
  upper_->chain.mount(surface, pattern);
}

const TaxelSignals& Sensitivity::read(const RigSample& sample) {
  const TaxelSignals& low = lower_->read(sample);
  const TaxelSignals& high = upper_->read(sample);
  derivative_.skew = (high.skew - low.skew) / step_;
  difference(high.offset, low.offset, step_, derivative_.offset);
  difference(high.load, low.load, step_, derivative_.load);
  difference(high.gain, low.gain, step_, derivative_.gain);
  difference(high.conductance, low.conductance, step_, derivative_.conductance);
  difference(high.reading, low.reading, step_, derivative_.reading);
  return derivative_;
}

}  // namespace fsr::simulation
