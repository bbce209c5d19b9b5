// Rests and breaks: no load for a time.
//
// The rest counts from the begin of the step, or from the time at which the pressure is down. A load before
// its end, less the tolerance of dwells, is rejected. A longer rest is no mistake.

#include <algorithm>

#include "conductor/step_watch.h"

namespace fsr::conductor {

namespace {

constexpr double kRestPatience = 30;  // beyond the planned time of venting, until a complaint [s]

class RestWatch : public StepWatch {
 public:
  RestWatch(const session_plan::SessionStep& step, double begin) : step_(step), begin_(begin) {}

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
    verdict.sentence = "a load of " + kPaText(now_.pressure) + " came after " + timeText(length_) +
                       " without load, planned are " + timeText(step_.dwell_rest);
    return verdict;
  }

  const session_plan::SessionStep step_;
  const double begin_;
  Reading now_;
  bool rested_ = false;
  double length_ = 0;  // of the rest [s]
};

}  // namespace

std::unique_ptr<StepWatch> restWatch(const session_plan::SessionStep& step, double begin) {
  return std::make_unique<RestWatch>(step, begin);
}

}  // namespace fsr::conductor
