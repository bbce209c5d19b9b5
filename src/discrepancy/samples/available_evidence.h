#pragma once

#include <string>

#include "discrepancy/samples/measured.h"
#include "fsr_pressure_map/simulation/effect_info.h"

namespace fsr::discrepancy {

/// Which evidence the recordings contain. Effects need evidence before they are named.
struct AvailableEvidence {
  bool thermometer = false;
  bool two_rates = false;  ///< ramps of two speeds, or dwells
  bool mount_labels = false;
  bool remounted = false;  ///< at least one surface was mounted twice
  bool temperature_moved = false;
  bool uneven_pace = false;   ///< many cycles at some times and none for hours at others
  bool two_sessions = false;  ///< some mount was recorded in two recordings with an interruption between them
  bool uneven_warmth = false;  ///< over hours the temperature was not proportional to clock time
  bool has(simulation::Evidence evidence) const;
  /// Whether the covariate of a slow effect was not proportional to clock time, so that the effect can be
  /// distinguished from a drift.
  bool apartFromClock(const simulation::EffectInfo& slow) const {
    return simulation::dependsOn(slow, simulation::Covariate::kTemperature) ? uneven_warmth : uneven_pace;
  }
};
AvailableEvidence availableEvidence(const Measured& measured);

}  // namespace fsr::discrepancy
