#include "discrepancy/decide/changes.h"

#include <algorithm>
#include <string>

#include "fsr_pressure_map/settings/input_error.h"
#include "simulation/effects/effect_library.h"

namespace fsr::discrepancy {

namespace {

// Removes the added effects of the other kind. With `read_out` the effects of the read-out stay, otherwise
// those up to the gain.
simulation::SimulationSettings keepStages(simulation::SimulationSettings settings,
                                          const simulation::SimulationSettings& base, bool read_out) {
  auto& effects = settings.effects;
  effects.erase(std::remove_if(effects.begin(), effects.end(),
                               [&](const simulation::EnabledEffect& effect) {
                                 const bool late = simulation::libraryOf(base).info(effect.id).stage >=
                                                   simulation::ChainStage::kConductance;
                                 return !base.effect(effect.id) && late != read_out;
                               }),
                effects.end());
  return settings;
}

// Replaces the changes on flat surfaces by those of `flat`.
void onFlat(const Measured& measured, const Changes& flat, Changes& changes) {
  for (std::size_t i = 0; i < measured.samples(); ++i) {
    if (!dataset::isFlat(measured.classes[measured.classOf(i)])) continue;
    const auto at = static_cast<Eigen::Index>(i);
    changes.load[at] = flat.load[at];
    changes.reading[at] = flat.reading[at];
    changes.gain[at] = flat.gain[at];
  }
}

// Scales the gain to a mean of 1 in each class of curvature. A gain that a whole class shares is part of its
// static curve. Without the scaling the residual, including the noise, would be divided by this gain, and a
// large gain would seem to explain it. With the scaling this cannot happen: where the mean of g is 1, the
// mean of 1 / g^2 is at least 1.
void levelGain(const Measured& measured, Changes& changes) {
  const auto classes = static_cast<Eigen::Index>(measured.classes.size());
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(classes), number = sum;
  for (std::size_t i = 0; i < measured.samples(); ++i) {
    const auto c = static_cast<Eigen::Index>(measured.classOf(i));
    sum[c] += changes.gain[static_cast<Eigen::Index>(i)];
    number[c] += 1;
  }
  for (std::size_t i = 0; i < measured.samples(); ++i) {
    const auto c = static_cast<Eigen::Index>(measured.classOf(i));
    changes.gain[static_cast<Eigen::Index>(i)] *= number[c] / std::max(1e-9, sum[c]);
  }
}

Trace freedOf(const Trace& common, double unloaded, const Changes& changes) {
  return ((common - changes.reading).array() - unloaded) / changes.gain.array().max(0.05) + unloaded;
}

}  // namespace

simulation::SimulationSettings withEffect(simulation::SimulationSettings settings,
                                          const simulation::EnabledEffect& effect) {
  const std::vector<std::string> order = simulation::libraryOf(settings).ids();
  const auto place = [&](const std::string& id) { return std::find(order.begin(), order.end(), id); };
  auto& effects = settings.effects;
  effects.erase(std::remove_if(effects.begin(), effects.end(),
                               [&](const simulation::EnabledEffect& e) { return e.id == effect.id; }),
                effects.end());
  const auto after = std::find_if(effects.begin(), effects.end(), [&](const simulation::EnabledEffect& e) {
    return place(e.id) > place(effect.id);
  });
  effects.insert(after, effect);
  return settings;
}

Changes changesBy(const Measured& measured, const simulation::SimulationSettings& base,
                  const simulation::SimulationSettings& added, const DrivenSignals& without,
                  bool state_kept) {
  const simulation::SimulationSettings early = keepStages(added, base, false),
                                       late = keepStages(added, base, true);
  const auto samples = without.load.size();
  Changes changes{Trace::Zero(samples), Trace::Ones(samples), Trace::Zero(samples)};
  if (early.effects.size() > base.effects.size()) {
    const DrivenSignals with = driven(measured, early, state_kept);
    changes.load = with.load - without.load;
    changes.gain = with.gain.cwiseQuotient(without.gain.cwiseMax(1e-9));
  }
  if (late.effects.size() > base.effects.size()) {
    changes.reading = driven(measured, late, state_kept).reading - without.reading;
  }
  return changes;
}

Trace loadOf(const Measured& measured, const Changes& changes) {
  return Eigen::Map<const Trace>(measured.loads().data(), changes.load.size()) + changes.load;
}

// A trace that is 0 in the hold-out cycles.
Trace withoutHoldOut(const Measured& measured, Trace trace) {
  for (const MeasuredCycle& cycle : measured.cycles) {
    if (cycle.use == CycleUse::kFit) continue;
    const auto samples = static_cast<Eigen::Index>(cycle.last - cycle.first);
    trace.segment(static_cast<Eigen::Index>(cycle.first), samples).setZero();
  }
  return trace;
}

Changes Forward::changes(const std::vector<simulation::EnabledEffect>& effects,
                         const std::vector<bool>& bent_only) const {
  simulation::SimulationSettings bent = base_, flat = base_;
  for (std::size_t e = 0; e < effects.size(); ++e) {
    bent = withEffect(bent, effects[e]);
    if (!bent_only[e]) flat = withEffect(flat, effects[e]);
  }
  Changes changes = changesBy(measured_, base_, bent, plain_, state_kept_);
  if (flat.effects.size() < bent.effects.size())
    onFlat(measured_, changesBy(measured_, base_, flat, plain_, state_kept_), changes);
  levelGain(measured_, changes);
  return changes;
}

std::optional<Trace> Forward::left(const std::vector<simulation::EnabledEffect>& effects,
                                   const std::vector<bool>& bent_only) const {
  try {
    const Changes changes = this->changes(effects, bent_only);
    const Trace freed = freedOf(common_.all, fit_.unloaded(), changes);
    return withoutHoldOut(measured_, StaticFit(fit_, freed, loadOf(measured_, changes)).project(freed));
  } catch (const settings::InputError&) {
    return std::nullopt;
  }
}

Trace Forward::explained(const std::vector<simulation::EnabledEffect>& effects,
                         const std::vector<bool>& bent_only) const {
  const Changes changes = this->changes(effects, bent_only);
  const Trace freed = freedOf(common_.all, fit_.unloaded(), changes);
  const Trace after = StaticFit(fit_, freed, loadOf(measured_, changes)).residual(freed);
  return fit_.residual(common_.all) - after.cwiseProduct(changes.gain);
}

}  // namespace fsr::discrepancy
