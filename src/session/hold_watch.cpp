// A pressure that is held. It counts from the time at which the pressure is within the tolerance of the peak.
// The pace is judged where the hold begins at rest.

#include <algorithm>
#include <cmath>

#include "session/step_watch.h"

namespace fsr::session {

namespace {

class HoldWatch : public StepWatch {
 public:
  explicit HoldWatch(const SessionStep& step)
      : step_(step),
        crossings_(0, step.peak),
        low_(step.peak - std::max(step.peak_error, kRestLevel)),
        high_(step.peak + std::max(step.peak_error, kRestLevel)) {}

  std::optional<Verdict> take(const Reading& reading, const RestClock& rest) override {
    crossings_.take(reading);
    if (rest.resting()) from_rest_ = true;
    lowest_ = std::min(lowest_, reading.pressure);
    if (reading.pressure - lowest_ > 0.1 * step_.peak) begun_ = true;
    if (running()) measured_.peak = std::fmax(measured_.peak, reading.pressure);
    return inside_since_ ? holding(reading) : approaching(reading);
  }
  bool running() const override { return begun_ || inside_since_; }
  Hint hint() const override {
    return running() && !inside_since_ ? crossings_.stalledHint(step_.peak) : Hint{};
  }

 private:
  std::optional<Verdict> approaching(const Reading& reading) {
    if (reading.pressure > high_ && begun_) return overshot();
    if (reading.pressure >= low_ && reading.pressure <= high_) {
      inside_since_ = last_steady_ = reading.time;
      if (!from_rest_ || !crossings_.fillRate()) return std::nullopt;
      measured_.fill_rate = *crossings_.fillRate();
      const Hint pace = judgeRate(step_, measured_.fill_rate, true);
      if (pace.reason != Reason::kNone) return reject(pace.reason, pace.sentence);
      return std::nullopt;
    }
    if (begun_ && reading.pressure < low_ && measured_.peak - reading.pressure > 0.1 * step_.peak &&
        measured_.peak < low_) {
      return reject(Reason::kPeakMissed, "the pressure turned at " + kPaText(measured_.peak) +
                                             ", planned are " + kPaText(step_.peak));
    }
    return std::nullopt;
  }
  std::optional<Verdict> holding(const Reading& reading) {
    const double length = reading.time - *inside_since_;
    if (reading.pressure > high_) return overshot();
    if (reading.pressure >= step_.peak - 0.5 * (step_.peak - low_)) last_steady_ = reading.time;
    if (reading.pressure >= low_) {
      measured_.dwell = length;
      return length >= step_.dwell_peak ? accept() : std::nullopt;
    }
    if (measured_.dwell >= step_.dwell_peak - step_.dwell_error) return accept();
    // From half of the tolerance to all of it, at less than half of the pace of venting: not by the valve.
    const double fall = 0.5 * (step_.peak - low_) / std::max(reading.time - last_steady_, 1e-9);
    const std::string when =
        " after " + secondsText(length) + ", planned are " + secondsText(step_.dwell_peak);
    if (fall < 0.5 * step_.vent_rate)
      return reject(Reason::kLeak, "leak: the pressure fell slowly to " + kPaText(reading.pressure) + when);
    return reject(Reason::kDwellTooShort, "the pressure was let go" + when);
  }
  std::optional<Verdict> overshot() {
    return reject(Reason::kPeakOvershot,
                  "the pressure rose to " + kPaText(measured_.peak) + ", planned are " + kPaText(step_.peak));
  }
  std::optional<Verdict> reject(Reason reason, const std::string& sentence) {
    return Verdict{reason, sentence, measured_};
  }
  std::optional<Verdict> accept() { return Verdict{Reason::kNone, "", measured_}; }

  const SessionStep step_;
  LevelCrossings crossings_;
  const double low_, high_;  // what counts as the held pressure [Pa]
  Measured measured_;
  bool from_rest_ = false;
  double lowest_ = 1e9;                 // [Pa]
  bool begun_ = false;                  // the pressure has risen
  std::optional<double> inside_since_;  // [s]
  double last_steady_ = 0;              // last reading in the upper part of what counts [s]
};

}  // namespace

std::unique_ptr<StepWatch> holdWatch(const SessionStep& step) {
  return std::make_unique<HoldWatch>(step);
}

}  // namespace fsr::session
