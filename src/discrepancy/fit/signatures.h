#pragma once

#include <string>
#include <vector>

#include "discrepancy/fit/static_fit.h"
#include "discrepancy/samples/measured.h"
#include "simulation/effect.h"

namespace fsr::discrepancy {

/// What one strength of one effect, with certain shapes, would add to the common trace.
struct Signature {
  std::string id;
  std::string strength;
  simulation::EffectValues values;  ///< of all parameters but the strength
  bool state_kept = true;  ///< the sheet remembers from one visit to the next, else each starts afresh
  bool free_sign = false;
  double scale = 1;  ///< strength per unit of `trace`; its sign is that of the rule
  double left = 0;   ///< share of its rms that the static curves and cycle gains leave
  Trace trace;       ///< projected, scaled to rms 1 before it was [-]
};

/// What a simulation without memory says of one taxel in the middle of the scatter: 1 x 1, no noise.
simulation::SimulationSettings representative(const simulation::SimulationSettings& settings);

/// The course of a chain's signals under the recorded pressure, surfaces and temperature.
struct DrivenSignals {
  Trace load;     ///< [Pa]
  Trace gain;     ///< factor
  Trace reading;  ///< [share of full scale]
};

/// The derivative of all signals with respect to one strength.
DrivenSignals drivenDerivative(const Measured& measured, const simulation::SimulationSettings& settings,
                               const std::string& id, const std::string& strength,
                               const simulation::EffectValues& values, bool state_kept);

/// The signals of a chain.
DrivenSignals driven(const Measured& measured, const simulation::SimulationSettings& settings,
                     bool state_kept);

/// What a change of load and gain does to the common trace, through the measured static curves' slope.
Trace throughCurve(const StaticFit& fit, const DrivenSignals& derivative, simulation::ChainStage stage);

/// Signatures of all effects that `settings` does not enable and that act on all taxels alike, for
/// each combination of the shapes' tried values. Where an effect has a memory, both carried over and
/// afresh. In the library's order.
std::vector<Signature> signatures(const Measured& measured, const StaticFit& fit,
                                  const simulation::SimulationSettings& settings,
                                  const std::vector<std::string>& leave_out, unsigned threads);

}  // namespace fsr::discrepancy
