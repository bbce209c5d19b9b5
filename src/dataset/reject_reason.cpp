#include "dataset/reject_reason.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace fsr::dataset {

namespace {

constexpr std::pair<RejectReason, const char*> kReasonNames[] = {
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

constexpr RejectReason kMisleading[] = {
    RejectReason::kSheetOff,     RejectReason::kPressureLost, RejectReason::kPressureInvalid,
    RejectReason::kOtherSurface, RejectReason::kTaxelFellOut, RejectReason::kPressureNotFollowed,
};

constexpr char kRejected[] = " rejected (";

}  // namespace

std::string name(RejectReason reason) {
  for (const auto& [one, text] : kReasonNames) {
    if (one == reason) return text;
  }
  return "";
}

std::vector<RejectReason> allRejectReasons() {
  std::vector<RejectReason> all;
  for (const auto& entry : kReasonNames) all.push_back(entry.first);
  return all;
}

bool readingsMislead(RejectReason reason) {
  return std::find(std::begin(kMisleading), std::end(kMisleading), reason) != std::end(kMisleading);
}

std::string rejectLabel(const std::string& what, RejectReason reason, const std::string& sentence) {
  return what + kRejected + name(reason) + "): " + sentence;
}

RejectReason rejectReasonIn(const std::string& label) {
  const std::size_t at = label.find(kRejected);
  if (at == std::string::npos) return RejectReason::kNone;
  const std::size_t begin = at + sizeof kRejected - 1;
  const std::string called = label.substr(begin, label.find("): ", begin) - begin);
  for (const auto& [one, text] : kReasonNames) {
    if (called == text) return one;
  }
  return RejectReason::kNone;
}

}  // namespace fsr::dataset
