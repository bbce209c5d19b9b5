#include "session/step_watch.h"

#include <algorithm>
#include <cmath>

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
  return settings::roundedPressure(pressure, 3);
}

std::string secondsText(double time) {
  return settings::roundedText(time, 3) + " s";
}

namespace {

constexpr double kLow = 0.1, kHigh = 0.9;  // shares of the way
constexpr double kStalled = 15;            // time without a rise until a complaint [s]

double crossing(const Reading& a, const Reading& b, double level) {
  return a.time + (b.time - a.time) * (level - a.pressure) / (b.pressure - a.pressure);
}

std::string rateText(double rate) {
  return settings::roundedText(rate / 1e3, 3) + " kPa/s";
}

std::string plannedText(const std::string& planned) {
  return ", planned are " + planned;
}

// What is wrong with a rate; kNone = nothing.
Verdict judgeRate(const SessionStep& step, double rate, bool filling) {
  const double planned = filling ? step.fill_rate : step.vent_rate;
  const bool fast = rate > planned * (1 + step.rate_error), slow = rate < planned * (1 - step.rate_error);
  if (!fast && !slow) return {};
  const std::string sentence = std::string(filling ? "filled" : "vented") + " too " +
                               (fast ? "fast" : "slowly") + ": " + rateText(rate) +
                               plannedText(rateText(planned));
  if (filling) return {fast ? Reason::kFillTooFast : Reason::kFillTooSlow, sentence, {}};
  return {fast ? Reason::kVentTooFast : Reason::kVentTooSlow, sentence, {}};
}

Verdict notVented(double pressure, const std::string& base) {
  return {
      Reason::kRestNotReached,
      "the pressure stays at " + kPaText(pressure) + " and does not go down to " + base + "; open the vent",
      {}};
}

// Times at which a rise from `low` to `peak`, and the fall behind it, cross 10 % and 90 % of the way,
// interpolated between readings. The paces are the mean ones between these two levels.
class LevelCrossings {
 public:
  LevelCrossings(double low, double peak)
      : low_level_(low + kLow * (peak - low)), high_level_(low + kHigh * (peak - low)) {}

  void take(const Reading& now) {
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

  double lowLevel() const { return low_level_; }    // 10 % [Pa]
  double highLevel() const { return high_level_; }  // 90 % [Pa]
  // Pace of the rise, once it has crossed 90 %, and of the fall, once it has crossed 10 % [Pa/s].
  std::optional<double> fillRate() const { return pace(up_low_, up_high_); }
  std::optional<double> ventRate() const { return pace(down_high_, down_low_); }
  // Time from crossing 90 % upwards to crossing it downwards, or to the last reading [s].
  double timeAbove() const { return up_high_ ? down_high_.value_or(last_->time) - *up_high_ : 0; }
  // "The chamber stays at ...", where the pressure has not risen for a while below 90 %.
  Verdict stalled(double peak) const {
    if (!last_ || up_high_ || last_->time - risen_ < kStalled) return {};
    return {Reason::kChamberStalled,
            "the pressure stays at " + kPaText(last_->pressure) + " and does not rise to " + kPaText(peak) +
                "; check supply and valves, or skip this step",
            {}};
  }

 private:
  std::optional<double> pace(const std::optional<double>& from, const std::optional<double>& to) const {
    if (!from || !to || !(*to > *from)) return std::nullopt;
    return (high_level_ - low_level_) / (*to - *from);
  }

  const double low_level_, high_level_;
  std::optional<Reading> last_;
  std::optional<double> up_low_, up_high_, down_high_, down_low_;  // [s]
  double highest_ = 0;  // when it had risen by 1 % of the way last: pressure [Pa]
  double risen_ = 0;    // and time [s]
};

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
      return verdict(Reason::kRestDisturbed, "a load of " + kPaText(now_.pressure) + " came after " +
                                                 secondsText(length_) + " without load" +
                                                 plannedText(secondsText(step_.dwell_rest)));
    }
    return std::nullopt;
  }
  bool running() const override { return rested_; }
  Verdict hint() const override {
    const double venting = std::max(0.0, step_.duration - step_.dwell_rest);
    if (rested_ || now_.pressure <= kRestLevel || now_.time - begin_ < venting + kRestPatience) return {};
    return notVented(now_.pressure, "rest");
  }

 private:
  Verdict verdict(Reason reason = Reason::kNone, const std::string& sentence = "") const {
    Verdict verdict{reason, sentence, {}};
    verdict.measured.rest = length_;
    return verdict;
  }

  const SessionStep step_;
  const double begin_;
  Reading now_;
  bool rested_ = false;
  double length_ = 0;  // of the rest [s]
};

// What holds, cycles and loops have in common: they rise to a peak.
class PeakWatch : public StepWatch {
 protected:
  PeakWatch(const SessionStep& step, double base)
      : step_(step), tolerance_(std::max(step.peak_error, kRestLevel)), crossings_(base, step.peak) {}

  std::optional<Verdict> accept() { return Verdict{Reason::kNone, "", measured_}; }
  std::optional<Verdict> reject(Reason reason, const std::string& sentence) {
    return Verdict{reason, sentence, measured_};
  }
  std::optional<Verdict> missed() {
    return reject(Reason::kPeakMissed,
                  "the pressure turned at " + kPaText(measured_.peak) + plannedText(kPaText(step_.peak)));
  }
  std::optional<Verdict> overshot() {
    return reject(Reason::kPeakOvershot,
                  "the pressure rose to " + kPaText(measured_.peak) + plannedText(kPaText(step_.peak)));
  }
  // Verdict on a pace; none where it is right.
  std::optional<Verdict> wrongPace(double rate, bool filling) {
    const Verdict pace = judgeRate(step_, rate, filling);
    return pace.accepted() ? std::nullopt : reject(pace.reason, pace.sentence);
  }

  const SessionStep step_;
  const double tolerance_;  // of the peak [Pa]
  LevelCrossings crossings_;
  Measured measured_;
  double lowest_ = 1e9;  // [Pa]
};

// A pressure that is held. It counts from the time at which the pressure is within the tolerance of the peak.
// The pace is judged where the hold begins at rest.
class HoldWatch : public PeakWatch {
 public:
  explicit HoldWatch(const SessionStep& step)
      : PeakWatch(step, 0), low_(step.peak - tolerance_), high_(step.peak + tolerance_) {}

  std::optional<Verdict> take(const Reading& reading, const RestClock& rest) override {
    crossings_.take(reading);
    if (rest.resting()) from_rest_ = true;
    lowest_ = std::min(lowest_, reading.pressure);
    if (reading.pressure - lowest_ > 0.1 * step_.peak) begun_ = true;
    if (running()) measured_.peak = std::fmax(measured_.peak, reading.pressure);
    if (reading.pressure > high_ && running()) return overshot();
    return inside_since_ ? holding(reading) : approaching(reading);
  }
  bool running() const override { return begun_ || inside_since_; }
  Verdict hint() const override {
    return running() && !inside_since_ ? crossings_.stalled(step_.peak) : Verdict{};
  }

 private:
  std::optional<Verdict> approaching(const Reading& reading) {
    if (reading.pressure >= low_ && reading.pressure <= high_) {
      inside_since_ = last_steady_ = reading.time;
      if (!from_rest_ || !crossings_.fillRate()) return std::nullopt;
      measured_.fill_rate = *crossings_.fillRate();
      return wrongPace(measured_.fill_rate, true);
    }
    const bool turned = begun_ && reading.pressure < low_ && measured_.peak < low_ &&
                        measured_.peak - reading.pressure > 0.1 * step_.peak;
    return turned ? missed() : std::nullopt;
  }
  std::optional<Verdict> holding(const Reading& reading) {
    const double length = reading.time - *inside_since_;
    if (reading.pressure >= step_.peak - 0.5 * tolerance_) last_steady_ = reading.time;
    if (reading.pressure >= low_) {
      measured_.dwell = length;
      return length >= step_.dwell_peak ? accept() : std::nullopt;
    }
    if (measured_.dwell >= step_.dwell_peak - step_.dwell_error) return accept();
    // From half of the tolerance to all of it, at less than half of the pace of venting: not by the valve.
    const double fall = 0.5 * tolerance_ / std::max(reading.time - last_steady_, 1e-9);
    const std::string when = " after " + secondsText(length) + plannedText(secondsText(step_.dwell_peak));
    if (fall < 0.5 * step_.vent_rate)
      return reject(Reason::kLeak, "leak: the pressure fell slowly to " + kPaText(reading.pressure) + when);
    return reject(Reason::kDwellTooShort, "the pressure was let go" + when);
  }

  const double low_, high_;  // what counts as the held pressure [Pa]
  bool from_rest_ = false;
  bool begun_ = false;                  // the pressure has risen
  std::optional<double> inside_since_;  // [s]
  double last_steady_ = 0;              // last reading in the upper part of what counts [s]
};

// Cycles, conditioning cycles and partial loops: from a base to the peak and back, in four phases.
//
// Base: rest, or the low pressure of a loop. The rest before the filling is judged when the filling begins.
//
// Up: until 90 % of the way. The pace is judged there. If the pressure turns before, the peak was missed.
//
// Top: until the pressure falls through 90 %. Above the peak's tolerance it is rejected at once.
//
// Down: until the base. If the pressure rises again before, the unloading is missing.
//
// The dwell is the time above 90 % of the way less the two ramps there, at the measured paces. It is a leak
// if the pressure, once it has left the peak, falls at less than half of the planned pace and much more
// slowly than it does in the venting that follows.
constexpr double kDwellPatience =
    10;  // time above the planned dwell and its tolerance, until it is rejected [s]
constexpr double kVentPatience = 30;  // time beyond the planned time of venting, until a complaint [s]

class ExcursionWatch : public PeakWatch {
 public:
  ExcursionWatch(const SessionStep& step, bool after_loop)
      : PeakWatch(step, step.kind == StepKind::kLoop ? step.low : 0),
        loop_(step.kind == StepKind::kLoop),
        base_(loop_ ? step.low : 0),
        end_(loop_ ? std::min(base_ + tolerance_, base_ + 0.1 * (step.peak - base_)) : kRestLevel),
        after_loop_(after_loop) {}

  std::optional<Verdict> take(const Reading& reading, const RestClock& rest) override {
    now_ = reading;
    crossings_.take(reading);
    if (phase_ == Phase::kBase) return base(rest);
    measured_.peak = std::max(measured_.peak, reading.pressure);
    return phase_ == Phase::kUp ? up() : phase_ == Phase::kTop ? top() : down();
  }
  bool running() const override { return phase_ != Phase::kBase; }
  Verdict hint() const override {
    if (phase_ == Phase::kUp) return crossings_.stalled(step_.peak);
    const bool waits = (phase_ == Phase::kBase && !armed_) || phase_ == Phase::kDown;
    if (!waits || !since_ || now_.time - *since_ < longestVenting()) return {};
    return notVented(now_.pressure, baseText());
  }

 private:
  enum class Phase { kBase, kUp, kTop, kDown };

  std::string baseText() const { return loop_ ? kPaText(base_) : "rest"; }

  std::optional<Verdict> base(const RestClock& rest) {
    if (!since_) since_ = now_.time;
    const bool at_base = loop_ ? now_.pressure <= base_ + tolerance_ : rest.resting();
    lowest_ = std::min(lowest_, now_.pressure);
    armed_ = armed_ || at_base;
    if (!armed_ || at_base) return std::nullopt;
    if (loop_ && now_.pressure <= crossings_.lowLevel()) return std::nullopt;
    phase_ = Phase::kUp;
    measured_.peak = now_.pressure;
    if (loop_) {
      if (!after_loop_ || lowest_ >= base_ - tolerance_) return std::nullopt;
      return reject(Reason::kBaseMissed, "the pressure fell to " + kPaText(lowest_) + " before the loop" +
                                             plannedText(kPaText(base_)));
    }
    measured_.rest = rest.length();
    if (measured_.rest >= step_.dwell_rest - step_.dwell_error) return std::nullopt;
    return reject(Reason::kRestTooShort, "filling began after " + secondsText(measured_.rest) +
                                             " without load" + plannedText(secondsText(step_.dwell_rest)));
  }

  std::optional<Verdict> up() {
    if (now_.pressure >= crossings_.highLevel()) {
      phase_ = Phase::kTop;
      left_ = now_.time;
      measured_.fill_rate = crossings_.fillRate().value_or(measured_.fill_rate);
      const std::optional<Verdict> wrong = wrongPace(measured_.fill_rate, true);
      return wrong ? wrong : top();
    }
    const bool down = now_.pressure <= (loop_ ? base_ : kRestLevel);
    const double fall = measured_.peak - now_.pressure;
    return down || fall >= std::max(tolerance_, 0.1 * (step_.peak - base_)) ? missed() : std::nullopt;
  }

  std::optional<Verdict> top() {
    if (now_.pressure > step_.peak + tolerance_) return overshot();
    noteFall();
    if (now_.pressure < crossings_.highLevel()) {
      if (measured_.peak < step_.peak - tolerance_) return missed();
      phase_ = Phase::kDown;
      since_ = now_.time;
      lowest_ = now_.pressure;
      return down();
    }
    const double ramps = ramp(step_.fill_rate) + ramp(step_.vent_rate);
    if (crossings_.timeAbove() < step_.dwell_peak + 2 * step_.dwell_error + 2 * ramps + kDwellPatience)
      return std::nullopt;
    measured_.dwell = crossings_.timeAbove() - ramp(step_.fill_rate);
    return reject(Reason::kNoUnloading, "the pressure stays at " + kPaText(now_.pressure) +
                                            " for longer than the planned dwell of " +
                                            secondsText(step_.dwell_peak) + "; vent");
  }
  // When the pressure leaves the highest one by a quarter of the tolerance, and by all of it.
  void noteFall() {
    if (now_.pressure >= measured_.peak - 0.25 * tolerance_) {
      left_ = now_.time;
      fallen_.reset();
    } else if (!fallen_ && now_.pressure < measured_.peak - tolerance_) {
      fallen_ = now_;
    }
  }
  // Time of a ramp between 90 % of the way and the highest pressure [s].
  double ramp(double rate) const {
    return rate > 0 ? std::max(0.0, measured_.peak - crossings_.highLevel()) / rate : 0;
  }

  std::optional<Verdict> down() {
    noteFall();
    lowest_ = std::min(lowest_, now_.pressure);
    if (now_.pressure <= end_) return finish();
    if (now_.pressure < lowest_ + std::max(tolerance_, 0.05 * (step_.peak - base_))) return std::nullopt;
    return reject(Reason::kNoUnloading,
                  "the pressure rose again at " + kPaText(lowest_) + " before it was down to " + baseText());
  }
  // With a stop on the way, neither dwell nor pace of the venting can be told [s].
  double longestVenting() const {
    const double planned = step_.vent_rate > 0 ? (step_.peak - base_) / step_.vent_rate : 0;
    return 2 * planned + kVentPatience;
  }
  std::optional<Verdict> finish() {
    measured_.vent_rate = crossings_.ventRate().value_or(step_.vent_rate);
    const double venting = (step_.peak - base_) / measured_.vent_rate;
    if (venting >= longestVenting()) {
      return reject(Reason::kRestNotReached, "at the pace from 90 to 10 % of the way, venting takes " +
                                                 secondsText(venting) + "; vent without a stop");
    }
    measured_.dwell =
        std::max(0.0, crossings_.timeAbove() - ramp(measured_.fill_rate) - ramp(measured_.vent_rate));
    if (leaked()) {
      return reject(Reason::kLeak, "leak: the pressure fell slowly from " + kPaText(measured_.peak) + " to " +
                                       kPaText(fallen_->pressure) + " before it was vented");
    }
    const std::string dwell = "the pressure stayed at the peak for " + secondsText(measured_.dwell) +
                              plannedText(secondsText(step_.dwell_peak));
    if (measured_.dwell < step_.dwell_peak - step_.dwell_error) return reject(Reason::kDwellTooShort, dwell);
    if (measured_.dwell > step_.dwell_peak + step_.dwell_error) return reject(Reason::kDwellTooLong, dwell);
    const std::optional<Verdict> wrong = wrongPace(measured_.vent_rate, false);
    return wrong ? wrong : accept();
  }
  bool leaked() const {
    if (!fallen_ || !(fallen_->time > left_)) return false;
    const double fall = (measured_.peak - 0.25 * tolerance_ - fallen_->pressure) / (fallen_->time - left_);
    return fall < 0.5 * step_.vent_rate && fall < 0.6 * measured_.vent_rate;
  }

  const bool loop_;
  const double base_, end_;  // [Pa]
  const bool after_loop_;
  Phase phase_ = Phase::kBase;
  Reading now_;
  bool armed_ = false;             // the pressure has been at the base
  std::optional<double> since_;    // when it began to wait for the base, or to vent [s]
  double left_ = 0;                // last reading near the highest pressure [s]
  std::optional<Reading> fallen_;  // first one below its tolerance
};

}  // namespace

std::unique_ptr<StepWatch> watchOf(const SessionStep& step, double begin, bool after_loop) {
  switch (step.kind) {
    case StepKind::kMount:
      return nullptr;
    case StepKind::kRest:
    case StepKind::kBreak:
      return std::make_unique<RestWatch>(step, begin);
    case StepKind::kHold:
      return std::make_unique<HoldWatch>(step);
    default:
      return std::make_unique<ExcursionWatch>(step, after_loop);
  }
}

bool canBegin(const SessionStep& step, double pressure) {
  if (step.kind == StepKind::kLoop) return pressure <= step.low + std::max(step.peak_error, kRestLevel);
  return pressure <= kRestLevel;
}

}  // namespace fsr::session
