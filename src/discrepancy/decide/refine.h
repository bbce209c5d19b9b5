#pragma once

#include <string>
#include <vector>

#include "discrepancy/fit/signatures.h"
#include "discrepancy/fit/static_fit.h"
#include "discrepancy/samples/measured.h"
#include "fsr_pressure_map/discrepancy/discrepancy.h"
#include "simulation/effects/effect_library.h"

namespace fsr::discrepancy {

/// Settings with one more effect, in the library's order.
simulation::SimulationSettings withEffect(simulation::SimulationSettings settings,
                                          const simulation::EnabledEffect& effect);

/// Effects whose parameters fit the common trace best, on the cycles that are not held out, through the
/// true forward model.
struct Refined {
  std::vector<simulation::EnabledEffect> effects;
  std::vector<std::vector<FittedParameter>> parameters;  ///< of each effect, those that were fitted
  Trace trace;             ///< what they take away from what the static curves left of the common trace
  Trace left;              ///< of the projected common trace, 0 in hold-out cycles
  double share = 0;        ///< of the squared error of the projected common trace
  bool at_bound = false;   ///< a strength left its plausible range
  bool state_kept = true;  ///< as it was asked for
};

/// Whether the intervals of all strengths hold the value at which the effects do nothing; false where no
/// strength was fitted.
bool mayBeNone(const Refined& refined,
               const simulation::EffectLibrary& library = simulation::EffectLibrary::shipped());

/// `bent_only`, of each effect: it acts where the surface is bent, and nowhere else; empty = none does.
Refined refine(const Measured& measured, const CommonTraces& common, const StaticFit& fit,
               const simulation::SimulationSettings& base,
               const std::vector<simulation::EnabledEffect>& start, bool state_kept,
               std::vector<bool> bent_only);

/// Takes what `with` has beyond `without` out of the readings: from now on curves are functions of the load
/// that the chain computes, and readings are as they would be without.
void takeOut(Measured& measured, const StaticFit& fit, const simulation::SimulationSettings& without,
             const simulation::SimulationSettings& with);

/// The same for all effects with a time course that the simulation enables, their sizes fitted first.
/// Returns the simulation with these sizes. `beside`: effects that are fitted together with them and stay in.
simulation::SimulationSettings takeOutEnabled(Measured& measured, const CommonTraces& common,
                                              const StaticFit& fit,
                                              const simulation::SimulationSettings& base, bool fit_sizes,
                                              const std::vector<simulation::EnabledEffect>& beside = {});

/// What fixed effects explain of new recordings.
struct Predicted {
  double share = 0;       ///< of the squared error of the projected common trace, nothing fitted
  double best_share = 0;  ///< the same with the effects' size free
  double size = 1;        ///< that fits best, common factor of all strengths
  Interval interval;      ///< of it
};
Predicted predict(const Measured& measured, const CommonTraces& common, const StaticFit& fit,
                  const simulation::SimulationSettings& base,
                  const std::vector<simulation::EnabledEffect>& effects);

}  // namespace fsr::discrepancy
