#pragma once

#include <limits>
#include <string>

#include "dataset/reject_reason.h"

namespace fsr::conductor {

/// Why a step was rejected, or what hinders it. It stands where the readers of bags find it, too.
using Reason = dataset::RejectReason;

/// What was measured of one attempt. NaN = the step has no such thing, or it was not reached.
struct Measured {
  double peak = std::numeric_limits<double>::quiet_NaN();       ///< highest pressure, gauge [Pa]
  double fill_rate = std::numeric_limits<double>::quiet_NaN();  ///< from 10 % to 90 % of the step [Pa/s]
  double vent_rate = std::numeric_limits<double>::quiet_NaN();  ///< from 90 % to 10 % [Pa/s]
  double dwell = std::numeric_limits<double>::quiet_NaN();      ///< at the peak, without the ramps [s]
  double rest = std::numeric_limits<double>::quiet_NaN();       ///< without load before it [s]
};

/// Accepted, or rejected for a reason.
struct Verdict {
  Reason reason = Reason::kNone;
  std::string sentence;  ///< for a person: what is wrong, with the measured and the planned value
  Measured measured;

  bool accepted() const { return reason == Reason::kNone; }
};

}  // namespace fsr::conductor
