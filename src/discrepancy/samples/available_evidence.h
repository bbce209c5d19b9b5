#pragma once

#include <set>
#include <vector>

#include "discrepancy/samples/measured.h"
#include "fsr_pressure_map/simulation/effect_info.h"

namespace fsr::discrepancy {

/// Which evidence the recordings contain. Effects need evidence before they are named.
struct AvailableEvidence {
  bool thermometer = false;
  bool two_rates = false;  ///< ramps of two speeds, or dwells
  bool mount_labels = false;
  bool remounted = false;     ///< at least one surface was mounted twice
  bool uneven_pace = false;   ///< many cycles at some times and none for hours at others
  bool two_sessions = false;  ///< some mount was recorded in two recordings with an interruption between them
  bool has(simulation::Evidence evidence) const;
  bool hasAll(const std::vector<simulation::Evidence>& evidence) const;
  /// What of it is lacking and a protocol of a chamber provides.
  std::set<simulation::Evidence> lacking(const std::vector<simulation::Evidence>& evidence) const;
};
AvailableEvidence availableEvidence(const Measured& measured);

}  // namespace fsr::discrepancy
