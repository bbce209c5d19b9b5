#pragma once

#include <string>
#include <vector>

#include "fsr_pressure_map/discrepancy/discrepancy.h"
#include "fsr_pressure_map/discrepancy/measured.h"
#include "fsr_pressure_map/discrepancy/signatures.h"
#include "fsr_pressure_map/discrepancy/static_fit.h"

namespace fsr {

/// Settings with one more effect, in the library's order.
SimulationSettings withEffect(SimulationSettings settings, const EnabledEffect& effect);

/// What `added` says beyond `base` of the common trace: the chains' difference of load and gain, through
/// the measured static curves, not only their slope.
Trace addedTrace(const Measured& measured, const StaticFit& fit, const SimulationSettings& base,
                 const SimulationSettings& added, bool carried);

/// Effects whose parameters fit the common trace best, on the cycles that are not shown, through the
/// true forward model: Levenberg and Marquardt's steps from the values given.
struct Refined {
  std::vector<EnabledEffect> effects;
  std::vector<std::vector<FittedParameter>> parameters;  ///< of each effect, those that were fitted
  Trace trace;                                           ///< what they add to the common trace
  double share = 0;       ///< of the squared error of the projected common trace
  bool at_bound = false;  ///< a strength left its plausible range
};
Refined refine(const Measured& measured, const CommonTraces& common, const SimulationSettings& base,
               const std::vector<EnabledEffect>& start, bool carried);

}  // namespace fsr
