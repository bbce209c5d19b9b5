#pragma once

#include <string>
#include <vector>

#include "discrepancy/fit/signatures.h"
#include "discrepancy/fit/static_fit.h"
#include "discrepancy/samples/measured.h"
#include "fsr_pressure_map/discrepancy/discrepancy.h"
#include "simulation/effects/effect_library.h"

namespace fsr::discrepancy {

/// Adds an effect to the settings, or replaces it. The effects stay in the library's order.
simulation::SimulationSettings withEffect(simulation::SimulationSettings settings,
                                          const simulation::EnabledEffect& effect);

/// Effects with the parameters that fit the common trace best through the true forward model. The fit uses
/// the cycles that are not held out.
struct Refined {
  std::vector<simulation::EnabledEffect> effects;
  std::vector<std::vector<FittedParameter>> parameters;  ///< fitted parameters of each effect
  Trace trace;               ///< part of the common trace's residual that the effects explain
  Trace left;                ///< residual of the projected common trace; 0 in hold-out cycles
  double share = 0;          ///< share of the projected common trace's squared error that they explain
  bool implausible = false;  ///< a strength is larger than its plausible range, with 95 % confidence
  bool state_kept = true;    ///< as passed to refine()
  ParameterSpread spread;    ///< of the parameters; not between groups of cycles
};

/// Whether the intervals of all strengths contain the value at which the effects do nothing. False where no
/// strength was fitted.
bool mayBeNone(const Refined& refined,
               const simulation::EffectLibrary& library = simulation::EffectLibrary::shipped());

/// Whether an effect without a detector changes with time under a uniform pressure.
bool hasTimeCourse(const simulation::EffectInfo& info);

/// `bent_only` has one flag for each effect: true = it acts only where the surface is bent. Empty = all
/// false.
Refined refine(const Measured& measured, const CommonTraces& common, const StaticFit& fit,
               const simulation::SimulationSettings& base,
               const std::vector<simulation::EnabledEffect>& start, bool state_kept,
               std::vector<bool> bent_only);

/// Subtracts the effects that are in `with` but not in `without` from the readings. Afterwards the curves are
/// functions of the load that the chain computes, and the readings are those of a sheet without these
/// effects.
void takeOut(Measured& measured, const StaticFit& fit, const simulation::SimulationSettings& without,
             const simulation::SimulationSettings& with);

/// The same for all effects with a time course that the simulation enables. With `fit_sizes` their sizes are
/// fitted first. Returns the simulation with these sizes. `beside`: effects that are fitted together with
/// them but are not subtracted.
simulation::SimulationSettings takeOutEnabled(Measured& measured, const CommonTraces& common,
                                              const StaticFit& fit,
                                              const simulation::SimulationSettings& base, bool fit_sizes,
                                              const std::vector<simulation::EnabledEffect>& beside = {});

/// What effects with fixed parameters explain of new recordings.
struct Predicted {
  double share = 0;     ///< share of the projected common trace's squared error, without any fit
  double size = 1;      ///< common factor of all strengths that fits best
  double variance = 0;  ///< of `size`, by the scatter between these cycles
  /// Variance of the size that fits best if the effects are right, by the spread of their parameters.
  double of_spread = 0;
  Trace trace;  ///< what the effects of this size add to the common trace's residual
  /// Of each cycle: the size that fits it best, less `size`, and the information on it.
  std::vector<double> apart, information;
};
/// `spread`: of the effects' parameters. Under another protocol than that of the fit, a shape that is not
/// well known changes the size that fits best.
Predicted predict(const Measured& measured, const CommonTraces& common, const StaticFit& fit,
                  const simulation::SimulationSettings& base,
                  const std::vector<simulation::EnabledEffect>& effects, const ParameterSpread& spread = {});

}  // namespace fsr::discrepancy
