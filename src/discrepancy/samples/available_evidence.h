#pragma once

#include <string>

#include "discrepancy/samples/measured.h"
#include "fsr_pressure_map/simulation/effect_info.h"

namespace fsr::discrepancy {

/// What the recordings hold, for effects that must not be named without it.
struct AvailableEvidence {
  bool thermometer = false;
  bool two_rates = false;  ///< or dwells
  bool mount_labels = false;
  bool remounted = false;  ///< some surface was mounted twice
  bool temperature_moved = false;
  bool uneven_pace = false;    ///< cycles in plenty at some time and none for hours at another
  bool uneven_warmth = false;  ///< the temperature went another way than the clock, over hours
  bool has(simulation::Evidence evidence) const;
  /// Whether what a slow effect follows went another way than the clock, so that a drift is told from it.
  bool apartFromClock(const simulation::EffectInfo& slow) const {
    return simulation::dependsOn(slow, simulation::Covariate::kTemperature) ? uneven_warmth : uneven_pace;
  }
};
AvailableEvidence availableEvidence(const Measured& measured);

}  // namespace fsr::discrepancy
