#pragma once

#include <limits>
#include <string>
#include <vector>

namespace fsr::conductor {

/// Why a step was rejected, or what hinders it.
enum class Reason {
  kNone,
  kPeakMissed,       ///< the pressure turned before the peak
  kPeakOvershot,     ///< above the peak
  kFillTooFast,      ///< filling
  kFillTooSlow,      ///< likewise
  kVentTooFast,      ///< venting
  kVentTooSlow,      ///< likewise
  kDwellTooShort,    ///< at the peak, or a hold
  kDwellTooLong,     ///< likewise
  kLeak,             ///< the pressure fell slowly during the dwell or the hold
  kNoUnloading,      ///< the pressure stayed up, or rose again before it was down
  kRestTooShort,     ///< filling began before the rest was over
  kRestDisturbed,    ///< a load during a rest or a break
  kRestNotReached,   ///< the pressure does not go down to rest
  kBaseMissed,       ///< a partial loop began below its low pressure
  kChamberStalled,   ///< the pressure does not rise to the peak
  kAboveLimit,       ///< above the limit of the chamber
  kPressureLost,     ///< no reading of the transducer
  kPressureInvalid,  ///< a reading that a chamber cannot have
  kScansLost,        ///< too many scans were lost, or none came
  kTaxelFellOut,     ///< a taxel died or got stuck
  kManySaturated,    ///< many taxels are at full scale
  kNotRecorded,      ///< the bag is not written
  kTimeJumped,       ///< the time ran backwards
  kNotConfirmed,     ///< pressure, but nobody has confirmed that the sheet is mounted
  kOtherSurface,     ///< another surface is declared than the plan's, or the sheet reads like another one
  kMountsDisagree,   ///< a mount that was recorded before reads like another surface
  kSheetOff,         ///< no taxel answers the pressure any more
  kDiskNearlyFull,   ///< the recordings that are left do not fit
  kNoTimeLeft,       ///< the plan does not fit into the time that is left
  kByHand,           ///< a person rejected it
};

/// "peak_missed" and so on; "" for kNone.
std::string name(Reason reason);
/// All reasons but kNone.
std::vector<Reason> allReasons();

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
