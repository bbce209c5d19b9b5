#pragma once

#include "fsr_pressure_map/settings/input_error.h"

namespace fsr::discrepancy {

/// Recordings that are sound, but have too few cycles to compare. A question about an effect has an answer
/// all the same: these recordings cannot show it.
class TooFewCycles : public settings::InputError {
 public:
  using InputError::InputError;
};

}  // namespace fsr::discrepancy
