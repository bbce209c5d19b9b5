#include "discrepancy/decide/enabled_columns.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "discrepancy/decide/changes.h"
#include "discrepancy/decide/take_out.h"
#include "discrepancy/fit/signatures.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "simulation/effects/effect_library.h"

namespace fsr::discrepancy {

namespace {

constexpr double kQuotientStep = 0.05;  // of a parameter, for a difference quotient

bool isFitted(const simulation::EffectParameter& parameter) {
  return parameter.role == simulation::ParameterRole::kStrength || !parameter.tried.empty();
}

// The effect with one parameter a step further; nothing where this is not permitted.
std::optional<simulation::EnabledEffect> stepped(const simulation::EnabledEffect& effect,
                                                 const simulation::EffectParameter& parameter) {
  simulation::EnabledEffect further = effect;
  double& value = further.values.at(parameter.name);
  const double step = kQuotientStep * (value != 0 ? std::abs(value) : std::abs(parameter.usual));
  if (!(step > 0) || !std::isfinite(step)) return std::nullopt;
  for (const double way : {1.0, -1.0}) {
    if (!parameter.permitted.contains(value + way * step)) continue;
    value += way * step;
    return further;
  }
  return std::nullopt;
}

Trace changeOf(const Measured& measured, const StaticFit& fit, const simulation::EffectInfo& info,
               const DrivenSignals& without, const simulation::SimulationSettings& further) {
  const DrivenSignals with = driven(measured, further, true);
  const DrivenSignals change{with.load - without.load,
                             with.gain.cwiseQuotient(without.gain.cwiseMax(1e-9)).array() - 1,
                             with.reading - without.reading};
  return throughCurve(measured, fit, change, info.stage, 0);
}

}  // namespace

Eigen::MatrixXd enabledColumns(const Measured& measured, const StaticFit& fit,
                               const simulation::SimulationSettings& settings) {
  Eigen::MatrixXd columns(static_cast<Eigen::Index>(measured.samples()), 0);
  std::optional<DrivenSignals> without;
  for (const simulation::EnabledEffect& effect : settings.effects) {
    const simulation::EffectInfo& info = measured.info(effect.id);
    if (!hasTimeCourse(info)) continue;
    for (const simulation::EffectParameter& parameter : info.parameters) {
      const auto further = isFitted(parameter) ? stepped(effect, parameter) : std::nullopt;
      if (!further) continue;
      if (!without) without = driven(measured, settings, true);
      Trace change;
      try {
        change = changeOf(measured, fit, info, *without, withEffect(settings, *further));
      } catch (const settings::InputError&) {
        continue;  // the effect refuses this combination of parameters
      }
      if (change.isZero(0)) continue;
      columns.conservativeResize(Eigen::NoChange, columns.cols() + 1);
      columns.col(columns.cols() - 1) = change;
    }
  }
  return columns;
}

}  // namespace fsr::discrepancy
