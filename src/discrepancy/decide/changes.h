#pragma once

#include <optional>
#include <vector>

#include "discrepancy/fit/signatures.h"
#include "discrepancy/fit/static_fit.h"
#include "discrepancy/samples/measured.h"
#include "fsr_pressure_map/simulation/simulation_settings.h"

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
                  const simulation::SimulationSettings& added, const DrivenSignals& without, bool state_kept);

/// Load that the static curves see [Pa].
Trace loadOf(const Measured& measured, const Changes& changes);

/// A trace that is 0 in the hold-out cycles.
Trace withoutHoldOut(const Measured& measured, Trace trace);

/// The common trace as a function of the effects that the simulation lacks. The static curves are fitted
/// again for each (variable projection).
class Forward {
 public:
  Forward(const Measured& measured, const CommonTraces& common, const StaticFit& fit,
          const simulation::SimulationSettings& base, bool state_kept)
      : measured_(measured),
        common_(common),
        fit_(fit),
        base_(base),
        state_kept_(state_kept),
        plain_(driven(measured, base, state_kept)) {}

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
  bool state_kept_;
  DrivenSignals plain_;
};

}  // namespace fsr::discrepancy
