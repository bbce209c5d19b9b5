#include "conductor/verdict.h"

#include <utility>

namespace fsr::conductor {

namespace {

constexpr std::pair<Reason, const char*> kNames[] = {
    {Reason::kPeakMissed, "peak_missed"},
    {Reason::kPeakOvershot, "peak_overshot"},
    {Reason::kFillTooFast, "fill_too_fast"},
    {Reason::kFillTooSlow, "fill_too_slow"},
    {Reason::kVentTooFast, "vent_too_fast"},
    {Reason::kVentTooSlow, "vent_too_slow"},
    {Reason::kDwellTooShort, "dwell_too_short"},
    {Reason::kDwellTooLong, "dwell_too_long"},
    {Reason::kLeak, "leak"},
    {Reason::kNoUnloading, "no_unloading"},
    {Reason::kRestTooShort, "rest_too_short"},
    {Reason::kRestDisturbed, "rest_disturbed"},
    {Reason::kRestNotReached, "rest_not_reached"},
    {Reason::kBaseMissed, "base_missed"},
    {Reason::kChamberStalled, "chamber_stalled"},
    {Reason::kAboveLimit, "above_limit"},
    {Reason::kPressureLost, "pressure_lost"},
    {Reason::kPressureInvalid, "pressure_invalid"},
    {Reason::kScansLost, "scans_lost"},
    {Reason::kTaxelFellOut, "taxel_fell_out"},
    {Reason::kManySaturated, "many_saturated"},
    {Reason::kNotRecorded, "not_recorded"},
    {Reason::kTimeJumped, "time_jumped"},
    {Reason::kNotConfirmed, "not_confirmed"},
    {Reason::kOtherSurface, "other_surface"},
    {Reason::kMountsDisagree, "mounts_disagree"},
    {Reason::kSheetOff, "sheet_off"},
    {Reason::kDiskNearlyFull, "disk_nearly_full"},
    {Reason::kNoTimeLeft, "no_time_left"},
    {Reason::kByHand, "by_hand"},
};

}  // namespace

std::string name(Reason reason) {
  for (const auto& [one, text] : kNames) {
    if (one == reason) return text;
  }
  return "";
}

std::vector<Reason> allReasons() {
  std::vector<Reason> all;
  for (const auto& entry : kNames) all.push_back(entry.first);
  return all;
}

}  // namespace fsr::conductor
