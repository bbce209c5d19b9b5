#pragma once

#include <string>
#include <vector>

#include "discrepancy/fit/signatures.h"
#include "discrepancy/fit/static_fit.h"
#include "discrepancy/samples/measured.h"
#include "fsr_pressure_map/discrepancy/discrepancy.h"
#include "simulation/effects/effect_library.h"

namespace fsr::discrepancy {

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

/// `bent_only` has one flag for each effect: true = it acts only where the surface is bent. Empty = all
/// false.
Refined refine(const Measured& measured, const CommonTraces& common, const StaticFit& fit,
               const simulation::SimulationSettings& base,
               const std::vector<simulation::EnabledEffect>& start, bool state_kept,
               std::vector<bool> bent_only);

}  // namespace fsr::discrepancy
