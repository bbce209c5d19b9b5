#pragma once

#include <optional>
#include <string>
#include <vector>

#include "discrepancy/fit/signatures.h"
#include "discrepancy/fit/static_fit.h"
#include "discrepancy/samples/measured.h"
#include "fsr_pressure_map/discrepancy/discrepancy.h"
#include "fsr_pressure_map/simulation/effect_info.h"
#include "fsr_pressure_map/simulation/simulation_settings.h"
#include "simulation/effects/effect_library.h"

namespace fsr::discrepancy {

/// Adds an effect to the settings, or replaces it. The effects stay in the library's order.
simulation::SimulationSettings withEffect(simulation::SimulationSettings settings,
                                          const simulation::EnabledEffect& effect);

/// Changes of load, gain and reading by effects, of each sample.
struct Changes {
  Trace load, gain, reading;  ///< [Pa], factor, [share of full scale]
};

/// Changes by the effects that `added` has beyond `base`, computed through the chain. `without` is what the
/// chain gives for `base`.
Changes changesBy(const Measured& measured, const simulation::SimulationSettings& base,
                  const simulation::SimulationSettings& added, const DrivenSignals& without);

/// Load that the static curves see [Pa].
Trace loadOf(const Measured& measured, const Changes& changes);

/// A trace that is 0 in the hold-out cycles.
Trace withoutHoldOut(const Measured& measured, Trace trace);

/// The common trace as a function of the effects that the simulation lacks. The static curves are fitted
/// again for each (variable projection).
class Forward {
 public:
  Forward(const Measured& measured, const CommonTraces& common, const StaticFit& fit,
          const simulation::SimulationSettings& base)
      : measured_(measured), common_(common), fit_(fit), base_(base), plain_(driven(measured, base)) {}

  /// Residual of the projected common trace with the effects; 0 in hold-out cycles. None where their
  /// parameters are not permitted. `bent_only`: of each effect, see refine().
  std::optional<Trace> left(const std::vector<simulation::EnabledEffect>& effects,
                            const std::vector<bool>& bent_only) const;
  /// What the effects take off the residual of the common trace.
  Trace explained(const std::vector<simulation::EnabledEffect>& effects,
                  const std::vector<bool>& bent_only) const;

 private:
  Changes changes(const std::vector<simulation::EnabledEffect>& effects,
                  const std::vector<bool>& bent_only) const;

  const Measured& measured_;
  const CommonTraces& common_;
  const StaticFit& fit_;
  const simulation::SimulationSettings& base_;
  DrivenSignals plain_;
};

/// Effects with the parameters that fit the common trace best through the true forward model. The fit uses
/// the cycles that are not held out.
struct Refined {
  std::vector<simulation::EnabledEffect> effects;
  std::vector<std::vector<FittedParameter>> parameters;  ///< fitted parameters of each effect
  Trace trace;               ///< part of the common trace's residual that the effects explain
  Trace left;                ///< residual of the projected common trace; 0 in hold-out cycles
  double share = 0;          ///< share of the projected common trace's squared error that they explain
  bool implausible = false;  ///< a strength is larger than its plausible range, with 95 % confidence
  ParameterSpread spread;    ///< of the parameters; not between groups of cycles
};

/// Whether the intervals of all strengths contain the value at which the effects do nothing. False where no
/// strength was fitted.
bool mayBeNone(const Refined& refined,
               const simulation::EffectLibrary& library = simulation::EffectLibrary::shipped());

/// `bent_only` has one flag for each effect: true = it acts only where the surface is bent. Empty = all
/// false.
Refined refine(const Measured& measured, const CommonTraces& common, const StaticFit& fit,
               const simulation::SimulationSettings& base,
               const std::vector<simulation::EnabledEffect>& start, std::vector<bool> bent_only);

/// Whether an effect without a detector changes with time under a uniform pressure.
bool hasTimeCourse(const simulation::EffectInfo& info);

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

}  // namespace fsr::discrepancy
