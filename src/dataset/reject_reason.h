#pragma once

#include <algorithm>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

namespace fsr::dataset {

/// Why the conductor of a session rejected an attempt at a step, or what hinders it.
enum class RejectReason {
  kNone,
  kPeakMissed,           ///< the pressure turned before the peak
  kPeakOvershot,         ///< above the peak
  kFillTooFast,          ///< filling
  kFillTooSlow,          ///< likewise
  kVentTooFast,          ///< venting
  kVentTooSlow,          ///< likewise
  kDwellTooShort,        ///< at the peak, or a hold
  kDwellTooLong,         ///< likewise
  kLeak,                 ///< the pressure fell slowly during the dwell or the hold
  kNoUnloading,          ///< the pressure stayed up, or rose again before it was down
  kRestTooShort,         ///< filling began before the rest was over
  kRestDisturbed,        ///< a load during a rest or a break
  kRestNotReached,       ///< the pressure does not go down to rest
  kBaseMissed,           ///< a partial loop began below its low pressure
  kChamberStalled,       ///< the pressure does not rise to the peak
  kAboveLimit,           ///< above the limit of the chamber
  kPressureLost,         ///< no reading of the transducer
  kPressureInvalid,      ///< a reading that a chamber cannot have
  kPressureNotFollowed,  ///< the pressure jumped, and no taxel followed
  kScansLost,            ///< too many scans were lost, or none came
  kTaxelFellOut,         ///< a taxel died or got stuck
  kManySaturated,        ///< many taxels are at full scale
  kNotRecorded,          ///< the bag is not written
  kTimeJumped,           ///< the time ran backwards
  kNotConfirmed,         ///< pressure, but nobody has confirmed that the sheet is mounted
  kOtherSurface,         ///< another surface is declared than the plan's, or the sheet reads like another one
  kMountsDisagree,       ///< a mount that was recorded before reads like another surface
  kSheetOff,             ///< no taxel answers the pressure any more
  kDiskNearlyFull,       ///< the recordings that are left do not fit
  kNoTimeLeft,           ///< the plan does not fit into the time that is left
  kByHand,               ///< a person rejected it
};

/// "peak_missed" and so on; "" for kNone.
std::string name(RejectReason reason);
/// All reasons but kNone.
std::vector<RejectReason> allRejectReasons();

/// Whether the readings of an attempt that was rejected so are not those of the sheet under the pressure and
/// on the surface that are recorded with them. All others are loadings like any other, if not those of the
/// plan.
bool readingsMislead(RejectReason reason);

/// The label of an event `reject`: "WHAT rejected (peak_missed): SENTENCE".
std::string rejectLabel(const std::string& what, RejectReason reason, const std::string& sentence);
/// The reason in such a label; kNone in any other one, e.g. one that a person wrote.
RejectReason rejectReasonIn(const std::string& label);

// ---- definitions -----------------------------------------------------------------------------------

inline constexpr std::pair<RejectReason, const char*> kReasonNames[] = {
    {RejectReason::kPeakMissed, "peak_missed"},
    {RejectReason::kPeakOvershot, "peak_overshot"},
    {RejectReason::kFillTooFast, "fill_too_fast"},
    {RejectReason::kFillTooSlow, "fill_too_slow"},
    {RejectReason::kVentTooFast, "vent_too_fast"},
    {RejectReason::kVentTooSlow, "vent_too_slow"},
    {RejectReason::kDwellTooShort, "dwell_too_short"},
    {RejectReason::kDwellTooLong, "dwell_too_long"},
    {RejectReason::kLeak, "leak"},
    {RejectReason::kNoUnloading, "no_unloading"},
    {RejectReason::kRestTooShort, "rest_too_short"},
    {RejectReason::kRestDisturbed, "rest_disturbed"},
    {RejectReason::kRestNotReached, "rest_not_reached"},
    {RejectReason::kBaseMissed, "base_missed"},
    {RejectReason::kChamberStalled, "chamber_stalled"},
    {RejectReason::kAboveLimit, "above_limit"},
    {RejectReason::kPressureLost, "pressure_lost"},
    {RejectReason::kPressureInvalid, "pressure_invalid"},
    {RejectReason::kPressureNotFollowed, "pressure_not_followed"},
    {RejectReason::kScansLost, "scans_lost"},
    {RejectReason::kTaxelFellOut, "taxel_fell_out"},
    {RejectReason::kManySaturated, "many_saturated"},
    {RejectReason::kNotRecorded, "not_recorded"},
    {RejectReason::kTimeJumped, "time_jumped"},
    {RejectReason::kNotConfirmed, "not_confirmed"},
    {RejectReason::kOtherSurface, "other_surface"},
    {RejectReason::kMountsDisagree, "mounts_disagree"},
    {RejectReason::kSheetOff, "sheet_off"},
    {RejectReason::kDiskNearlyFull, "disk_nearly_full"},
    {RejectReason::kNoTimeLeft, "no_time_left"},
    {RejectReason::kByHand, "by_hand"},
};

inline constexpr RejectReason kMisleadingReasons[] = {
    RejectReason::kSheetOff,     RejectReason::kPressureLost, RejectReason::kPressureInvalid,
    RejectReason::kOtherSurface, RejectReason::kTaxelFellOut, RejectReason::kPressureNotFollowed,
};

inline constexpr char kRejectedWord[] = " rejected (";

inline std::string name(RejectReason reason) {
  for (const auto& [one, text] : kReasonNames) {
    if (one == reason) return text;
  }
  return "";
}

inline std::vector<RejectReason> allRejectReasons() {
  std::vector<RejectReason> all;
  for (const auto& entry : kReasonNames) all.push_back(entry.first);
  return all;
}

inline bool readingsMislead(RejectReason reason) {
  return std::find(std::begin(kMisleadingReasons), std::end(kMisleadingReasons), reason) !=
         std::end(kMisleadingReasons);
}

inline std::string rejectLabel(const std::string& what, RejectReason reason, const std::string& sentence) {
  return what + kRejectedWord + name(reason) + "): " + sentence;
}

inline RejectReason rejectReasonIn(const std::string& label) {
  const std::size_t at = label.find(kRejectedWord);
  if (at == std::string::npos) return RejectReason::kNone;
  const std::size_t begin = at + sizeof kRejectedWord - 1;
  const std::string called = label.substr(begin, label.find("): ", begin) - begin);
  for (const auto& [one, text] : kReasonNames) {
    if (called == text) return one;
  }
  return RejectReason::kNone;
}

}  // namespace fsr::dataset
