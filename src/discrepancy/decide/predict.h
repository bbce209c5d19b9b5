#pragma once

#include <vector>

#include "discrepancy/fit/static_fit.h"
#include "discrepancy/samples/measured.h"
#include "fsr_pressure_map/discrepancy/discrepancy.h"
#include "fsr_pressure_map/simulation/simulation_settings.h"

namespace fsr::discrepancy {

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
