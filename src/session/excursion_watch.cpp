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

#include <algorithm>
#include <cmath>

#include "session/step_watch.h"

namespace fsr::session {

namespace {

constexpr double kDwellPatience =
    10;  // time above the planned dwell and its tolerance, until it is rejected [s]
constexpr double kVentPatience = 30;  // time beyond the planned time of venting, until a complaint [s]

class ExcursionWatch : public StepWatch {
 public:
  ExcursionWatch(const SessionStep& step, bool after_loop)
      : step_(step),
        loop_(step.kind == StepKind::kLoop),
        base_(loop_ ? step.low : 0),
        tolerance_(std::max(step.peak_error, kRestLevel)),
        end_(loop_ ? std::min(base_ + tolerance_, base_ + 0.1 * (step.peak - base_)) : kRestLevel),
        after_loop_(after_loop),
        crossings_(base_, step.peak) {}

  std::optional<Verdict> take(const Reading& reading, const RestClock& rest) override {
    now_ = reading;
    crossings_.take(reading);
    if (phase_ != Phase::kBase) highest_ = std::max(highest_, reading.pressure);
    switch (phase_) {
      case Phase::kBase:
        return base(rest);
      case Phase::kUp:
        return up();
      case Phase::kTop:
        return top();
      case Phase::kDown:
        break;
    }
    return down();
  }
  bool running() const override { return phase_ != Phase::kBase; }
  Hint hint() const override {
    if (phase_ == Phase::kUp) return crossings_.stalledHint(step_.peak);
    const bool waits = (phase_ == Phase::kBase && !armed_) || phase_ == Phase::kDown;
    if (!waits || !since_ || now_.time - *since_ < longestVenting()) return {};
    return {Reason::kRestNotReached, "the pressure stays at " + kPaText(now_.pressure) +
                                         " and does not go down to " +
                                         (loop_ ? kPaText(base_) : std::string("rest")) + "; open the vent"};
  }

 private:
  enum class Phase { kBase, kUp, kTop, kDown };

  std::optional<Verdict> base(const RestClock& rest) {
    if (!since_) since_ = now_.time;
    const bool at_base = loop_ ? now_.pressure <= base_ + tolerance_ : rest.resting();
    lowest_ = std::min(lowest_, now_.pressure);
    armed_ = armed_ || at_base;
    if (!armed_ || at_base) return std::nullopt;
    if (loop_ && now_.pressure <= crossings_.lowLevel()) return std::nullopt;
    phase_ = Phase::kUp;
    highest_ = now_.pressure;
    if (loop_) return loopBase();
    measured_.rest = rest.length();
    if (measured_.rest >= step_.dwell_rest - step_.dwell_error) return std::nullopt;
    return reject(Reason::kRestTooShort, "filling began after " + secondsText(measured_.rest) +
                                             " without load, planned are " + secondsText(step_.dwell_rest));
  }
  std::optional<Verdict> loopBase() {
    if (!after_loop_ || lowest_ >= base_ - tolerance_) return std::nullopt;
    return reject(Reason::kBaseMissed, "the pressure fell to " + kPaText(lowest_) +
                                           " before the loop, planned are " + kPaText(base_));
  }

  std::optional<Verdict> up() {
    if (now_.pressure >= crossings_.highLevel()) return reachTop();
    const bool down = now_.pressure <= (loop_ ? base_ : kRestLevel);
    if (!down && highest_ - now_.pressure < std::max(tolerance_, 0.1 * (step_.peak - base_)))
      return std::nullopt;
    return missed();
  }
  std::optional<Verdict> reachTop() {
    phase_ = Phase::kTop;
    left_ = now_.time;
    measured_.fill_rate = crossings_.fillRate().value_or(measured_.fill_rate);
    const Hint pace = judgeRate(step_, measured_.fill_rate, true);
    if (pace.reason != Reason::kNone) return reject(pace.reason, pace.sentence);
    return top();
  }
  std::optional<Verdict> missed() {
    return reject(Reason::kPeakMissed,
                  "the pressure turned at " + kPaText(highest_) + ", planned are " + kPaText(step_.peak));
  }

  std::optional<Verdict> top() {
    if (now_.pressure > step_.peak + tolerance_) {
      return reject(Reason::kPeakOvershot,
                    "the pressure rose to " + kPaText(highest_) + ", planned are " + kPaText(step_.peak));
    }
    noteFall();
    if (now_.pressure < crossings_.highLevel()) {
      if (highest_ < step_.peak - tolerance_) return missed();
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
    if (now_.pressure >= highest_ - 0.25 * tolerance_) {
      left_ = now_.time;
      fallen_.reset();
    } else if (!fallen_ && now_.pressure < highest_ - tolerance_) {
      fallen_ = now_;
    }
  }
  // Time of a ramp between 90 % of the way and the highest pressure [s].
  double ramp(double rate) const {
    return rate > 0 ? std::max(0.0, highest_ - crossings_.highLevel()) / rate : 0;
  }

  std::optional<Verdict> down() {
    noteFall();
    lowest_ = std::min(lowest_, now_.pressure);
    if (now_.pressure <= end_) return finish();
    if (now_.pressure < lowest_ + std::max(tolerance_, 0.05 * (step_.peak - base_))) return std::nullopt;
    return reject(Reason::kNoUnloading, "the pressure rose again at " + kPaText(lowest_) +
                                            " before it was down to " +
                                            (loop_ ? kPaText(base_) : std::string("rest")));
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
      return reject(Reason::kLeak, "leak: the pressure fell slowly from " + kPaText(highest_) + " to " +
                                       kPaText(fallen_->pressure) + " before it was vented");
    }
    const std::string dwell = "the pressure stayed at the peak for " + secondsText(measured_.dwell) +
                              ", planned are " + secondsText(step_.dwell_peak);
    if (measured_.dwell < step_.dwell_peak - step_.dwell_error) return reject(Reason::kDwellTooShort, dwell);
    if (measured_.dwell > step_.dwell_peak + step_.dwell_error) return reject(Reason::kDwellTooLong, dwell);
    const Hint pace = judgeRate(step_, measured_.vent_rate, false);
    return reject(pace.reason, pace.sentence);
  }
  bool leaked() const {
    if (!fallen_ || !(fallen_->time > left_)) return false;
    const double fall = (highest_ - 0.25 * tolerance_ - fallen_->pressure) / (fallen_->time - left_);
    return fall < 0.5 * step_.vent_rate && fall < 0.6 * measured_.vent_rate;
  }

  // kNone accepts.
  std::optional<Verdict> reject(Reason reason, const std::string& sentence) {
    measured_.peak = highest_;
    return Verdict{reason, sentence, measured_};
  }

  const SessionStep step_;
  const bool loop_;
  const double base_, tolerance_, end_;  // [Pa]
  const bool after_loop_;
  LevelCrossings crossings_;
  Phase phase_ = Phase::kBase;
  Reading now_;
  bool armed_ = false;             // the pressure has been at the base
  std::optional<double> since_;    // when it began to wait for the base, or to vent [s]
  double highest_ = 0;             // [Pa]
  double lowest_ = 1e9;            // at the base, and again behind the peak [Pa]
  double left_ = 0;                // last reading near the highest pressure [s]
  std::optional<Reading> fallen_;  // first one below its tolerance
  Measured measured_;
};

}  // namespace

std::unique_ptr<StepWatch> excursionWatch(const SessionStep& step, bool after_loop) {
  return std::make_unique<ExcursionWatch>(step, after_loop);
}

}  // namespace fsr::session
