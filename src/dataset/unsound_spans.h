#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
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

/// The chamber is at rest up to this gauge pressure [Pa]: twice the accuracy of the transducer of Ahmadizadeh
/// and Menon 2019 (Omega PX309, 0.25 % of 1.1 MPa).
constexpr double kRestLevel = 5e3;

/// The scans of a recording in the order of time, without their single taxels.
struct ScanCourse {
  std::vector<std::int64_t> stamp_ns;
  std::vector<double> pressure;          ///< of the chamber, gauge [Pa]
  std::vector<double> reading;           ///< mean of all taxels [counts]
  std::vector<std::uint32_t> condition;  ///< number of the surface and mount

  std::size_t scans() const { return stamp_ns.size(); }
};

/// The end of an attempt at a step, told by an event of the conductor.
struct AttemptEnd {
  std::int64_t stamp_ns = 0;
  RejectReason reason = RejectReason::kNone;  ///< kNone = accepted, or rejected by a person
};

/// Scans that are not readings of the sheet under the pressure recorded with them.
struct UnsoundSpan {
  std::size_t first = 0, end = 0;  ///< indices of scans; `end` is the first one behind the span
  std::string why;                 ///< "attempt rejected: sheet_off"
};

/// The attempts that were rejected for a reason by which readings mislead. A span begins at the last rest
/// before the attempt and ends at the first one after it; rest is that of the chamber and of the sheet. It
/// stays between the ends of the attempts before and after. `ends` ascend.
std::vector<UnsoundSpan> rejectedSpans(const ScanCourse& course, const std::vector<AttemptEnd>& ends);

/// "left out 353 scans that are not the sheet under the recorded pressure: 120.0 to 135.0 s (attempt
/// rejected: sheet_off)", with times since the first scan; empty without spans.
std::string unsoundText(const ScanCourse& course, const std::vector<UnsoundSpan>& spans);

/// Spans in which sheet and transducer contradict each other: "pressure without reading" (the sheet was taken
/// off or its plug pulled, the transducer jumped), "reading without pressure" (the transducer was unplugged,
/// whatever it reads then) or "pressure below rest". Nothing needs to be known of the sheet. On each surface,
/// the pressure whose rank among all pressures is the rank of the reading among all readings is what the
/// sheet says. It differs from the transducer's by loops, creep, drift and noise all the time. Contradicted
/// is a scan where it differs far beyond this, in pressure and in reading, for longer than clocks may differ.
/// Nothing is found where a sheet does not follow the pressure anyway, or where more than a quarter of the
/// scans contradicts the rest.
std::vector<UnsoundSpan> contradictions(const ScanCourse& course);

/// Rejected attempts, and contradictions that are not within one, in the order of time.
std::vector<UnsoundSpan> unsoundSpans(const ScanCourse& course, const std::vector<AttemptEnd>& ends);

}  // namespace fsr::dataset
