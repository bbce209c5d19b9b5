#include "conductor/step_watch.h"

#include <algorithm>

#include "settings/number_text.h"

namespace fsr::conductor {

using session_plan::SessionStep;
using session_plan::StepKind;

void RestClock::take(const Reading& reading) {
  if (reading.pressure <= kRestLevel) {
    if (!since_) since_ = begin_ = reading.time;
    last_ = reading.time;
  } else if (reading.pressure > kLoadLevel) {
    since_.reset();
  }
}

std::string kPaText(double pressure) {
  return settings::roundedText(pressure / 1e3, 3) + " kPa";
}

std::string rateText(double rate) {
  return settings::roundedText(rate / 1e3, 3) + " kPa/s";
}

std::string timeText(double time) {
  return settings::roundedText(time, 3) + " s";
}

Hint judgeRate(const SessionStep& step, double rate, bool filling) {
  const double planned = filling ? step.fill_rate : step.vent_rate;
  const bool fast = rate > planned * (1 + step.rate_error), slow = rate < planned * (1 - step.rate_error);
  if (!fast && !slow) return {};
  const std::string sentence = std::string(filling ? "filled" : "vented") + " too " +
                               (fast ? "fast" : "slowly") + ": " + rateText(rate) + ", planned are " +
                               rateText(planned);
  if (filling) return {fast ? Reason::kFillTooFast : Reason::kFillTooSlow, sentence};
  return {fast ? Reason::kVentTooFast : Reason::kVentTooSlow, sentence};
}

std::unique_ptr<StepWatch> watchOf(const SessionStep& step, double begin, bool after_loop) {
  switch (step.kind) {
    case StepKind::kMount:
      return nullptr;
    case StepKind::kRest:
    case StepKind::kBreak:
      return restWatch(step, begin);
    case StepKind::kHold:
      return holdWatch(step);
    default:
      return excursionWatch(step, after_loop);
  }
}

bool canBegin(const SessionStep& step, double pressure) {
  if (step.kind == StepKind::kLoop) return pressure <= step.low + std::max(step.peak_error, kRestLevel);
  return pressure <= kRestLevel;
}

}  // namespace fsr::conductor
