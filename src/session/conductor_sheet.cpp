// What the conductor reads from the counts of the matrix: whether the sheet answers the pressure at all, and
// whether it lies on the surface of the plan.

#include <algorithm>
#include <cmath>
#include <utility>

#include "session/conductor.h"

namespace fsr::session {

namespace {

constexpr unsigned kSilentScans = 3;               // in a row: one or two may be damaged
constexpr double kLowest = 0.1, kUpperHalf = 0.5;  // shares of the peak
constexpr double kUsualRamps = 2;  // times the planned pace: a person's ramps are slower, a jump is faster
// Of what the sheet reads under its largest load: it keeps less than that when it is vented.
constexpr double kRestShare = 0.1;

}  // namespace

bool Conductor::isFirstLoad() const {
  if (done() || !steps_[step_].loads() || !steps_[step_].recorded) return false;
  return std::none_of(steps_.data(), steps_.data() + step_, [this](const SessionStep& one) {
    return one.mount == steps_[step_].mount && one.recorded && one.loads();
  });
}

// A scan belongs to the pressure that was judged last, which is one reading old at most. A sheet that reads
// as under a load is not at rest, whatever the transducer says.
void Conductor::readMatrix(const ScanSummary& scan) {
  const bool answers =
      rest_counts_.known() && 2 * rest_counts_.answering(scan.counts, scan.taxels) >= scan.taxels;
  const double excess = rest_counts_.excess(scan.counts, scan.taxels);
  jumps_.scan({scan.time, excess, answers, 2 * scan.saturated >= scan.taxels});
  settleJump();
  // While a jump is open, the pressure that was judged last is of no scan.
  if (done() || !judged_ || jumps_.open() || waitsForMount()) return;
  const double pressure = last_judged_.pressure;
  if (pressure <= kRestLevel) {
    const bool rising = std::any_of(recent_.begin(), recent_.end(),
                                    [](const Reading& newer) { return newer.pressure > kRestLevel; });
    const bool loaded = largest_excess_ > 0 && excess > kRestShare * largest_excess_;
    if (!loaded && !rising) rest_counts_.take(scan.counts, scan.taxels);
    if (rest_counts_.known()) noise_ = rest_counts_.noise();
  } else if (attemptRuns() && steps_[step_].loads()) {
    checkSheet(scan);
    largest_excess_ = std::fmax(largest_excess_, excess);
  }
  if (done() || !isFirstLoad()) return;
  if (loading_step_ != step_ + 1) {
    loading_step_ = step_ + 1;
    loading_.begin(steps_[step_].peak);
    loading_columns_ = scan.columns;
  }
  loading_.take(pressure, scan.counts, scan.taxels);
}

// Whether a reading waits for what the sheet says of it, or is not that of the chamber.
bool Conductor::isDoubted(const Reading& reading) {
  const bool mounted = !done() && !waitsForMount() && steps_[step_].kind != StepKind::kBreak;
  if (unfollowed_) {
    unfollowed_ = mounted && !jumps_.agrees(reading.pressure);
    if (!unfollowed_) complain(Reason::kPressureNotFollowed, "", false);
    return unfollowed_;
  }
  const double since = reading.time - last_judged_.time;
  // Where the readings are rare, a ramp doubles the pressure between two of them.
  const double ramp =
      mounted ? kUsualRamps * std::max(steps_[step_].fill_rate, steps_[step_].vent_rate) * since : 0;
  const bool jumped = judged_ && since <= silence_ &&
                      std::abs(reading.pressure - last_judged_.pressure) > ramp &&
                      JumpWatch::isJump(last_judged_, reading);
  if (!jumps_.open() && mounted && jumped) jumps_.begin(last_judged_, reading);
  if (!jumps_.open()) return false;
  held_.push_back(reading);
  settleJump();
  return true;
}

// The readings since the jump count where the sheet followed it, and are dropped where it did not.
void Conductor::settleJump() {
  if (!jumps_.open()) return;
  const std::optional<bool> followed = jumps_.followed(now_, answered_);
  if (!followed) return;
  const std::vector<Reading> held = std::exchange(held_, {});
  if (*followed) {
    for (const Reading& reading : held) use(reading);
    return;
  }
  unfollowed_ = true;
  judged_ = false;
  rest_.restart();
  hinder(Reason::kPressureNotFollowed, "the pressure jumped from " + kPaText(jumps_.before().pressure) +
                                           " to " + kPaText(jumps_.after().pressure) +
                                           ", and the sheet did not follow: is the transducer plugged in?");
  recovering_ = watch_ != nullptr;
}

// The sheet is off where no taxel answers at a pressure at which half of them answered before: in this
// attempt, or, in the upper half of the way, in one that was accepted. The lowest tenth of the way is left
// out: a scan may be one reading younger than its pressure.
void Conductor::checkSheet(const ScanSummary& scan) {
  if (!rest_counts_.known() || scan.taxels == 0) return;
  const double peak = steps_[step_].peak;
  double pressure = last_judged_.pressure;
  for (const Reading& newer : recent_) pressure = std::min(pressure, newer.pressure);
  const std::size_t answering = rest_counts_.answering(scan.counts, scan.taxels);
  if (2 * answering >= scan.taxels) answers_ = std::min(answers_.value_or(pressure), pressure);
  const double enough = answers_ ? *answers_ : std::max(answered_.value_or(peak), kUpperHalf * peak);
  const bool silent = answering == 0 && pressure >= std::max(enough, kLowest * peak);
  silent_ = silent ? silent_ + 1 : 0;
  if (silent_ < kSilentScans) return;
  silent_ = 0;
  const std::optional<double> before = answers_ ? answers_ : answered_;
  spoil(Reason::kSheetOff,
        "no taxel answers " + kPaText(pressure) +
            (before ? ", but half of them answered " + kPaText(*before) + " before" : std::string()) +
            ": put the sheet back on its surface, or its plug in");
}

// The first loading of a mount, beside those of the mounts before.
Verdict Conductor::withSurface(Verdict verdict) {
  if (!isFirstLoad() || loading_step_ != step_ + 1) return verdict;
  const SessionStep& step = steps_[step_];
  const MountReading now{step.mount, step.surface, loading_columns_, loading_.result()};
  loading_step_ = 0;
  if (now.signature.empty()) return verdict;
  const std::optional<SurfaceDoubt> doubt = surfaces_.compare(now);
  if (doubt && doubt->mount == step.mount && doubted_ != step.mount) {
    doubted_ = step.mount;
    verdict.reason = Reason::kOtherSurface;
    verdict.sentence = doubt->sentence + ": look which surface lies in the chamber";
    return verdict;
  }
  if (doubt) insistOn(*doubt, &verdict);
  surfaces_.keep(now);
  return verdict;
}

// The present mount was looked at, or is not the one in doubt. So something recorded before is wrong, and can
// be no measure for what follows.
void Conductor::insistOn(const SurfaceDoubt& doubt, Verdict* verdict) {
  const SessionStep& step = steps_[step_];
  if (doubt.mount != step.mount) {
    verdict->sentence = doubt.sentence;
    surfaces_.forget(doubt.mount);
    if (doubt.swapped) surfaces_.forget(*doubt.swapped);
  } else {
    verdict->sentence =
        "accepted, because " + step.surface + " was confirmed twice, although " + doubt.sentence;
    for (const unsigned mount : doubt.against) surfaces_.forget(mount);
  }
  complain(Reason::kMountsDisagree, verdict->sentence + "; see which of their recordings can be used");
}

// All of it but the conditioning. Its bag does not count: it names a surface that is in doubt.
void Conductor::beginMountAgain(const Verdict& verdict) {
  for (std::size_t s = 0; s < step_; ++s) {
    if (steps_[s].mount == steps_[step_].mount && steps_[s].kind != StepKind::kCondition &&
        state_.steps[s] == StepState::kAccepted)
      state_.steps[s] = StepState::kOpen;
  }
  note(step_, StepState::kOpen, verdict, true);
  goOn();
  attempts_ = 1;
  last_rejected_ = verdict;
}

}  // namespace fsr::session
