#include "fsr_pressure_map/map/alarm.h"

#include <cmath>

#include "fsr_pressure_map/map/pressure_map.h"
#include "fsr_pressure_map/map/region.h"

namespace fsr {

namespace {

using namespace taxel_flag;

constexpr std::uint16_t kFailed = kDead | kStuck | kLineFault;
constexpr std::uint16_t kUnsure =
    kReadingExtrapolated | kCurvatureExtrapolated | kTemperatureExtrapolated | kFilled;

enum class Trust { kNobodysQuestion, kSure, kAtLeast, kLittle, kNone };

Trust trustIn(float pressure, std::uint16_t flags) {
  if ((flags & kMasked) != 0) return Trust::kNobodysQuestion;
  if (std::isnan(pressure) || (flags & kFailed) != 0) return Trust::kNone;
  if ((flags & kSaturated) != 0) return Trust::kAtLeast;
  const bool no_conductance = (flags & kBelowRange) != 0 && (flags & kCurvatureExtrapolated) == 0;
  if (no_conductance) return Trust::kLittle;
  return (flags & kUnsure) != 0 ? Trust::kNone : Trust::kSure;
}

}  // namespace

AlarmEvidence evidence(const PressureMap& map, const Region& region) {
  AlarmEvidence result;
  if (map.state != MapState::kOk) return result;
  result.whole = true;
  bool any = false;
  for (std::size_t i = 0; i < map.pressure.size(); ++i) {
    const Trust trust = region.has(i) ? trustIn(map.pressure[i], map.flags[i]) : Trust::kNobodysQuestion;
    if (trust == Trust::kNobodysQuestion) continue;
    any = true;
    if (trust == Trust::kNone || trust == Trust::kAtLeast) result.whole = false;
    if (trust != Trust::kNone) result.sure = std::fmax(result.sure, double(map.pressure[i]));
  }
  result.whole = result.whole && any;
  return result;
}

AlarmState Alarm::update(double time, const AlarmEvidence& evidence) {
  if (!options_.used()) return evidence.whole ? AlarmState::kOk : AlarmState::kUnknown;
  if (evidence.sure >= options_.threshold) {
    if (!above_ || time < above_since_) above_since_ = time;
    above_ = true;
    raised_ = raised_ || time - above_since_ >= options_.dwell;
  } else {
    above_ = false;
    if (evidence.whole && evidence.sure < options_.threshold - options_.hysteresis) raised_ = false;
  }
  if (raised_ && (above_ || evidence.whole)) return AlarmState::kAlarm;
  return evidence.whole ? AlarmState::kOk : AlarmState::kUnknown;
}

AlarmState Alarm::stale() {
  above_ = false;
  return AlarmState::kUnknown;
}

}  // namespace fsr
