#include "session/step_watch.h"

#include <algorithm>

#include "settings/number_text.h"

namespace fsr::session {

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

std::string secondsText(double time) {
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

namespace {

constexpr double kLow = 0.1, kHigh = 0.9;  // shares of the way
constexpr double kStalled = 15;            // time without a rise until a complaint [s]

double crossing(const Reading& a, const Reading& b, double level) {
  return a.time + (b.time - a.time) * (level - a.pressure) / (b.pressure - a.pressure);
}

}  // namespace

LevelCrossings::LevelCrossings(double low, double peak)
    : low_level_(low + kLow * (peak - low)), high_level_(low + kHigh * (peak - low)) {}

void LevelCrossings::take(const Reading& now) {
  if (last_) {
    const auto rises = [&](double level) { return last_->pressure < level && now.pressure >= level; };
    const auto falls = [&](double level) { return last_->pressure >= level && now.pressure < level; };
    if (rises(low_level_) && !up_high_) up_low_ = crossing(*last_, now, low_level_);
    if (rises(high_level_) && !up_high_) up_high_ = crossing(*last_, now, high_level_);
    if (falls(high_level_)) down_high_ = crossing(*last_, now, high_level_);
    if (falls(low_level_) && down_high_ && !down_low_) down_low_ = crossing(*last_, now, low_level_);
  }
  if (!last_ || now.pressure > highest_ + 0.01 * (high_level_ - low_level_)) {
    highest_ = now.pressure;
    risen_ = now.time;
  }
  last_ = now;
}

std::optional<double> LevelCrossings::fillRate() const {
  if (!up_low_ || !up_high_ || !(*up_high_ > *up_low_)) return std::nullopt;
  return (high_level_ - low_level_) / (*up_high_ - *up_low_);
}

std::optional<double> LevelCrossings::ventRate() const {
  if (!down_low_ || !(*down_low_ > *down_high_)) return std::nullopt;
  return (high_level_ - low_level_) / (*down_low_ - *down_high_);
}

double LevelCrossings::timeAbove() const {
  if (!up_high_) return 0;
  return (down_high_ ? *down_high_ : last_->time) - *up_high_;
}

Hint LevelCrossings::stalledHint(double peak) const {
  if (!last_ || up_high_ || last_->time - risen_ < kStalled) return {};
  return {Reason::kChamberStalled, "the pressure stays at " + kPaText(last_->pressure) +
                                       " and does not rise to " + kPaText(peak) +
                                       "; check supply and valves, or skip this step"};
}

namespace {

constexpr double kRestPatience = 30;  // beyond the planned time of venting, until a complaint [s]

class RestWatch : public StepWatch {
 public:
  RestWatch(const SessionStep& step, double begin) : step_(step), begin_(begin) {}

  std::optional<Verdict> take(const Reading& reading, const RestClock& rest) override {
    now_ = reading;
    if (rest.resting()) {
      rested_ = true;
      length_ = rest.lengthSince(begin_);
      if (length_ >= step_.dwell_rest) return verdict();
    } else if (rested_) {
      if (length_ >= step_.dwell_rest - step_.dwell_error) return verdict();
      return disturbed();
    }
    return std::nullopt;
  }
  bool running() const override { return rested_; }
  Hint hint() const override {
    const double venting = std::max(0.0, step_.duration - step_.dwell_rest);
    if (rested_ || now_.pressure <= kRestLevel || now_.time - begin_ < venting + kRestPatience) return {};
    return {Reason::kRestNotReached, "the pressure stays at " + kPaText(now_.pressure) +
                                         " and does not go down to rest; open the vent"};
  }

 private:
  Verdict verdict() const {
    Verdict verdict;
    verdict.measured.rest = length_;
    return verdict;
  }
  Verdict disturbed() const {
    Verdict verdict = RestWatch::verdict();
    verdict.reason = Reason::kRestDisturbed;
    verdict.sentence = "a load of " + kPaText(now_.pressure) + " came after " + secondsText(length_) +
                       " without load, planned are " + secondsText(step_.dwell_rest);
    return verdict;
  }

  const SessionStep step_;
  const double begin_;
  Reading now_;
  bool rested_ = false;
  double length_ = 0;  // of the rest [s]
};

}  // namespace

std::unique_ptr<StepWatch> restWatch(const SessionStep& step, double begin) {
  return std::make_unique<RestWatch>(step, begin);
}

}  // namespace fsr::session
