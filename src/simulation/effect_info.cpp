#include "fsr_pressure_map/simulation/effect_info.h"

#include <algorithm>
#include <stdexcept>

namespace fsr::simulation {

namespace {

EffectParameter make(std::string name, std::string meaning, ParameterRole role,
                     const settings::Range& permitted, double usual) {
  EffectParameter parameter{std::move(name), std::move(meaning), role, permitted, usual};
  parameter.plausible = permitted;
  if (role != ParameterRole::kShape) parameter.neutral = 0;
  return parameter;
}

template <typename Enumeration>
std::string nameOf(Enumeration value, const std::vector<const char*>& names) {
  return names.at(static_cast<std::size_t>(value));
}

}  // namespace

EffectParameter EffectParameter::within(double low, double high) const {
  EffectParameter changed = *this;
  changed.plausible = {low, high, permitted.unit};
  return changed;
}

EffectParameter EffectParameter::offAt(double value) const {
  EffectParameter changed = *this;
  changed.neutral = value;
  return changed;
}

EffectParameter EffectParameter::trying(std::vector<double> values) const {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  EffectParameter changed = within(*low, *high);
  changed.tried = std::move(values);
  return changed;
}

EffectParameter EffectParameter::ofRange() const {
  EffectParameter changed = *this;
  changed.of_range = true;
  return changed;
}

EffectParameter EffectParameter::scaledTo(double range) const {
  EffectParameter changed = *this;
  const auto scale = [&](double& value) {
    value = std::clamp(value * range / kUsualRange, permitted.low, permitted.high);
  };
  if (!of_range) return changed;
  scale(changed.usual);
  scale(changed.plausible.low);
  scale(changed.plausible.high);
  for (double& value : changed.tried) scale(value);
  return changed;
}

EffectParameter EffectParameter::inBaseFit(int place) const {
  EffectParameter changed = *this;
  changed.place_in_base_fit = place;
  return changed;
}

EffectParameter EffectParameter::fromTaxelDeviation() const {
  EffectParameter changed = *this;
  changed.from_taxel_deviation = true;
  return changed;
}

EffectParameter EffectParameter::walking(Walk what, std::string shape) const {
  EffectParameter changed = *this;
  changed.walk = what;
  changed.fades_over = std::move(shape);
  return changed;
}

EffectParameter strength(std::string name, std::string meaning, const settings::Range& permitted,
                         double usual) {
  return make(std::move(name), std::move(meaning), ParameterRole::kStrength, permitted, usual);
}

EffectParameter scatter(std::string name, std::string meaning, const settings::Range& permitted,
                        double usual) {
  return make(std::move(name), std::move(meaning), ParameterRole::kScatter, permitted, usual);
}

EffectParameter shape(std::string name, std::string meaning, const settings::Range& permitted, double usual) {
  return make(std::move(name), std::move(meaning), ParameterRole::kShape, permitted, usual);
}

const EffectParameter& parameter(const EffectInfo& info, const std::string& name) {
  for (const EffectParameter& candidate : info.parameters) {
    if (candidate.name == name) return candidate;
  }
  throw std::out_of_range(info.id + " has no parameter " + name);
}

std::vector<EffectParameter> strengths(const EffectInfo& info) {
  std::vector<EffectParameter> result;
  for (const EffectParameter& candidate : info.parameters) {
    if (candidate.role == ParameterRole::kStrength) result.push_back(candidate);
  }
  return result;
}

std::vector<EffectParameter> walks(const EffectInfo& info) {
  std::vector<EffectParameter> result;
  for (const EffectParameter& candidate : info.parameters) {
    if (candidate.walk != Walk::kNone) result.push_back(candidate);
  }
  return result;
}

bool dependsOn(const EffectInfo& info, Covariate covariate) {
  return std::count(info.depends_on.begin(), info.depends_on.end(), covariate) > 0;
}

std::string name(ChainStage stage) {
  return nameOf(stage, {"timing", "cavity", "load", "memory", "gain", "conductance", "read_out", "sample",
                        "reading", "reference"});
}

std::string name(EffectLevel level) {
  return nameOf(level, {"rig", "row", "column", "taxel", "mount", "session"});
}

std::string name(EffectKind kind) {
  return nameOf(kind, {"base", "additive", "grid", "detector", "listed"});
}

std::string name(ParameterRole role) {
  return nameOf(role, {"strength", "shape", "scatter"});
}

std::string name(SignRule sign) {
  return nameOf(sign, {"either", "positive", "negative"});
}

std::string name(Covariate covariate) {
  return nameOf(covariate, {"pressure", "direction", "pressure_rate", "time_since_reversal",
                            "previous_extremes", "cycle", "accumulated_change", "clock_time", "temperature",
                            "curvature", "mount", "row", "column", "taxel", "code", "total_load", "session"});
}

std::string name(Evidence evidence) {
  return nameOf(evidence, {"thermometer", "mount_labels", "two_ramp_rates", "uneven_load", "second_reference",
                           "vented_sheet", "many_cycles", "remounts", "uneven_pace", "two_sessions"});
}

std::string name(Experiment experiment) {
  return nameOf(experiment,
                {"none", "two_ramp_rates", "dwells", "step_and_hold", "minor_loops", "rest", "slow_start",
                 "two_ambients", "many_cycles", "remount", "flat_again", "uneven_load", "open_row",
                 "vented_sheet", "second_reference", "indenter_and_liner", "two_humidities", "new_session"});
}

}  // namespace fsr::simulation
