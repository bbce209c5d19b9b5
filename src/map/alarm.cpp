#include "fsr_pressure_map/map/region.h"

#include <cmath>

#include "fsr_pressure_map/map/pressure_map.h"

namespace fsr::map {

namespace {

using namespace taxel_flag;

constexpr std::uint16_t kFailed = kDead | kStuck | kLineFault;
constexpr std::uint16_t kUnsure =
    kReadingExtrapolated | kCurvatureExtrapolated | kTemperatureExtrapolated | kFilled;

enum class Trust { kNobodysQuestion, kSure, kAtLeast, kLessThan, kNone };

Trust trustIn(float pressure, std::uint16_t flags) {
  if ((flags & kMasked) != 0) return Trust::kNobodysQuestion;
  if (std::isnan(pressure) || (flags & kFailed) != 0) return Trust::kNone;
  if (isLowerLimit(flags)) return Trust::kAtLeast;
  const bool bent_as_trained = (flags & kCurvatureExtrapolated) == 0;
  if ((flags & kBelowRange) != 0 && bent_as_trained) return Trust::kLessThan;
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
    if (trust == Trust::kNone) continue;
    double& highest = trust == Trust::kLessThan ? result.less_than : result.sure;
    highest = std::fmax(highest, double(map.pressure[i]));
  }
  result.whole = result.whole && any;
  return result;
}

AlarmState Alarm::update(double time, const AlarmEvidence& evidence) {
  if (!options_.used()) return AlarmState::kNotSet;
  if (evidence.sure >= options_.threshold) {
    if (!above_ || time < above_since_) above_since_ = time;
    above_ = true;
    raised_ = raised_ || time - above_since_ >= options_.dwell;
  } else {
    above_ = false;
    const double highest = std::fmax(evidence.sure, evidence.less_than);
    if (evidence.whole && highest < options_.threshold - options_.hysteresis) raised_ = false;
  }
  if (raised_ && (above_ || evidence.whole)) return AlarmState::kAlarm;
  return withoutAlarm(evidence);
}

AlarmState Alarm::withoutAlarm(const AlarmEvidence& evidence) const {
  const bool may_be_above = evidence.less_than >= options_.threshold;
  return evidence.whole && !may_be_above ? AlarmState::kOk : AlarmState::kUnknown;
}

AlarmState Alarm::stale() {
  above_ = false;
  return options_.used() ? AlarmState::kUnknown : AlarmState::kNotSet;
}

}  // namespace fsr::map
