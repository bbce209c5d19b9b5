#include "session/conductor.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <utility>

#include "fsr_pressure_map/settings/input_error.h"
#include "settings/number_text.h"
#include "settings/sha256.h"
#include "settings/text.h"
#include "statistics/samples.h"

namespace fsr::session {

namespace {

constexpr double kJump = 1;               // stamps of one topic may be out of order by this much [s]
constexpr double kLeastPressure = -30e3;  // a gauge pressure below is no reading [Pa]
constexpr double kLostScans = 0.05;       // share of the scans of a step that may be lost
constexpr double kSaturated = 0.5;        // share of taxels at full scale from which it is said

std::string fallenText(unsigned taxels) {
  return std::to_string(taxels) + (taxels == 1 ? " taxel" : " taxels") +
         " fell out (dead or stuck); check the lines";
}

// How many mounts of a plan lie on a surface that came before.
std::size_t repeatedMounts(const SessionPlan& plan) {
  return mountsOf(plan) - std::min(mountsOf(plan), plan.surfaces.size());
}

std::string minutes(double time) {
  return settings::roundedText(std::ceil(time / 60), 4) + " min";
}

}  // namespace

std::string digestOf(const SessionPlan& plan) {
  std::string text;
  const auto add = [&text](const std::string& word) { text += word + "\n"; };
  const auto addNumbers = [&](std::initializer_list<double> numbers) {
    for (const double one : numbers) add(settings::numberText(one));
  };
  add(plan.name);
  addNumbers({plan.change, plan.chamber_limit});
  for (const SessionStep& step : sessionSteps(plan)) {
    add(name(step.kind) + " " + step.surface);
    addNumbers({1.0 * step.mount, step.recorded ? 1.0 : 0.0, step.low, step.peak, step.fill_rate,
                step.vent_rate, step.dwell_peak, step.dwell_rest, step.peak_error, step.rate_error,
                step.dwell_error});
  }
  for (const PlannedSurface& one : plan.surfaces) {
    add(one.surface.name);
    for (const matrix::Curvature& curvature : one.surface.curvature)
      addNumbers({curvature.x, curvature.y, curvature.xy});
    for (const double deviation : one.surface.deviation) add(settings::numberText(deviation));
  }
  return settings::sha256(text.data(), text.size());
}

Conductor::Conductor(const SessionPlan& plan, double silence)
    : plan_(plan), silence_(silence), steps_(sessionSteps(plan)), surfaces_(repeatedMounts(plan)) {
  state_.plan = plan.name;
  state_.digest = digestOf(plan);
  state_.steps.assign(steps_.size(), StepState::kOpen);
  restartWatch();
}

Conductor::Conductor(const SessionPlan& plan, const ConductorState& state, double silence)
    : Conductor(plan, silence) {
  if (state.digest != state_.digest || state.steps.size() != steps_.size()) {
    throw settings::InputError("the session that was begun is of the plan \"" + state.plan +
                               "\", which differs from " + plan.origin +
                               "; give that plan, or another file for the state of this one");
  }
  state_ = state;
  now_ = step_begin_ = state.time;
  goOn();
  resumed_ = !done() && steps_[step_].kind != StepKind::kMount && steps_[step_].kind != StepKind::kBreak;
}

Conductor::~Conductor() = default;
Conductor::Conductor(Conductor&&) noexcept = default;

// ---- input -----------------------------------------------------------------------------------------

void Conductor::pressure(double time, double gauge) {
  if (!passTime(time, last_pressure_)) return;
  if (!isValid(gauge)) return checkSilence();
  if (last_pressure_ && time <= *last_pressure_) return;
  if (last_pressure_ && time - *last_pressure_ > silence_) {
    spoil(Reason::kPressureLost,
          "no reading of the chamber pressure for " + secondsText(time - *last_pressure_));
    recent_.clear();
    rest_.restart();
  }
  last_pressure_ = time;
  complain(Reason::kPressureLost, "", false);
  const Reading reading{time, gauge};
  if (recent_.size() < 2) {
    recent_.push_back(reading);
    return;
  }
  const Reading middle{recent_[1].time,
                       statistics::upperMedian({recent_[0].pressure, recent_[1].pressure, gauge})};
  recent_[0] = recent_[1];
  recent_[1] = reading;
  judge(middle);
}

bool Conductor::isValid(double gauge) {
  const bool valid = std::isfinite(gauge) && gauge >= kLeastPressure;
  complain(Reason::kPressureInvalid,
           "the chamber pressure reads " + (std::isfinite(gauge) ? kPaText(gauge) : "nothing") +
               ": is the transducer plugged in?",
           !valid);
  return valid;
}

void Conductor::judge(const Reading& reading) {
  complain(Reason::kAboveLimit,
           "vent: " + kPaText(reading.pressure) + " is above the limit of the chamber, " +
               kPaText(plan_.chamber_limit),
           reading.pressure > plan_.chamber_limit);
  if (!isDoubted(reading)) use(reading);
}

void Conductor::use(const Reading& reading) {
  rest_before_ = rest_;
  rest_.take(reading);
  take(reading);
  last_judged_ = reading;
  judged_ = true;
  complainOfLoadBeforeMount(reading.pressure);
}

// Stays until a person confirms: who turned the valve may not have looked at the panel.
void Conductor::complainOfLoadBeforeMount(double pressure) {
  const bool loaded = pressure > kLoadLevel;
  if (!waitsForMount()) return complain(Reason::kNotConfirmed, "", false);
  if (!loaded && complaints_.count(Reason::kNotConfirmed) == 0) return;
  complain(Reason::kNotConfirmed, std::string(loaded ? "the pressure rises, but nobody has"
                                                     : "the pressure rose before anybody had") +
                                      " confirmed that the sheet lies on its surface");
}

void Conductor::take(const Reading& reading) {
  if (!watch_ || resumed_) return setHint();
  if (recovering_ && canBegin(steps_[step_], reading.pressure) && !isHindered()) {
    restartWatch();
    step_begin_ = reading.time;
  }
  if (recovering_) return setHint();
  const bool ran = attemptRuns();
  const std::optional<Verdict> verdict = watch_->take(reading, rest_);
  if (!ran && attemptRuns()) {
    scans_ = lost_ = silent_ = 0;
    answers_.reset();
  }
  if (verdict) handle(*verdict, reading);
  setHint();
}

void Conductor::handle(const Verdict& verdict, const Reading& reading) {
  const Verdict full = verdict.accepted() ? withScans(verdict) : verdict;
  if (!full.accepted()) return rejectStep(full);
  if (answers_ && steps_[step_].loads()) answered_ = std::max(answered_.value_or(0), *answers_);
  const Verdict compared = withSurface(full);
  if (!compared.accepted()) return beginMountAgain(compared);
  acceptStep(compared);
  if (!watch_) return;
  // The reading that ended one step may begin the next one.
  if (judged_) watch_->take(last_judged_, rest_before_);
  take(reading);
}

void Conductor::scan(const ScanSummary& scan) {
  if (!passTime(scan.time, last_scan_)) return;
  if (last_scan_ && attemptRuns() && steps_[step_].recorded && scan.time - *last_scan_ > silence_)
    spoil(Reason::kScansLost, "no scan came for " + secondsText(scan.time - *last_scan_));
  last_scan_ = last_scan_ ? std::max(*last_scan_, scan.time) : scan.time;
  ++scans_;
  lost_ += scan.lost;
  if (scan.counts != nullptr) readMatrix(scan);
  dead_ = scan.dead;
  if (!loaded_ || dead_ < dead_known_) dead_known_ = dead_;
  complain(Reason::kScansLost, "", false);
  complain(Reason::kTaxelFellOut, fallenText(dead_ - std::min(dead_, dead_known_)), dead_ > dead_known_);
  complain(Reason::kManySaturated,
           std::to_string(scan.saturated) + " of " + std::to_string(scan.taxels) +
               " taxels are at full scale and say only \"at least\"",
           scan.saturated > kSaturated * scan.taxels);
}

void Conductor::surface(const std::string& name) {
  declared_ = name;
  const bool other = !done() && !waitsForMount() && !declared_.empty() && declared_ != steps_[step_].surface;
  complain(Reason::kOtherSurface,
           "the sheet is declared to lie on " + declared_ + ", but the plan says " +
               (done() ? "" : steps_[step_].surface),
           other);
}

void Conductor::tick(double time) {
  if (!passTime(time, std::nullopt)) return;
  checkSilence();
  checkBreak();
  checkFit();
}

void Conductor::recordingTrouble(const std::string& sentence) {
  complain(Reason::kNotRecorded, sentence, !sentence.empty());
  if (!sentence.empty() && !done() && steps_[step_].recorded) spoil(Reason::kNotRecorded, sentence);
}

void Conductor::disk(double free_bytes, double bytes_per_second) {
  free_bytes_ = free_bytes;
  bytes_per_second_ = bytes_per_second;
  checkFit();
}

// ---- checks ----------------------------------------------------------------------------------------

void Conductor::jumpTo(double time) {
  spoil(Reason::kTimeJumped, "the time ran backwards by " + secondsText(now_ - time));
  recent_.clear();
  rest_.restart();
  judged_ = false;
  jumps_.drop();
  held_.clear();
  last_pressure_.reset();
  last_scan_.reset();
  now_ = step_begin_ = time;
  if (!recovering_) restartWatch();
}

// Takes the time of an input; `last`: that of the input before it on the same topic. One topic may be behind
// another. Returns false where the time ran backwards.
bool Conductor::passTime(double time, const std::optional<double>& last) {
  if (!std::isfinite(time)) return false;
  if (last && time < *last - kJump) {
    jumpTo(time);
    return false;
  }
  if (!started_ && !(step_begin_ > 0 && step_begin_ <= time)) {
    step_begin_ = time;
    restartWatch();
  }
  now_ = started_ ? std::max(now_, time) : time;
  started_ = true;
  return true;
}

void Conductor::checkSilence() {
  if (done() || !started_ || waitsForMount() || steps_[step_].kind == StepKind::kBreak) return;
  const double quiet = now_ - last_pressure_.value_or(step_begin_);
  const double blind = now_ - last_scan_.value_or(step_begin_);
  if (quiet > silence_) {
    const auto invalid = complaints_.find(Reason::kPressureInvalid);
    if (invalid == complaints_.end()) {
      hinder(Reason::kPressureLost, "no reading of the chamber pressure for " + secondsText(quiet));
    } else {
      spoil(Reason::kPressureInvalid, invalid->second);
    }
  }
  if (steps_[step_].recorded && blind > silence_)
    hinder(Reason::kScansLost, "no scan came for " + secondsText(blind));
}

// During a break the chamber may be switched off.
void Conductor::checkBreak() {
  if (done() || recovering_ || steps_[step_].kind != StepKind::kBreak) return;
  if (last_pressure_ && now_ - *last_pressure_ <= silence_) return;
  if (now_ - step_begin_ < steps_[step_].dwell_rest) return;
  Verdict verdict;
  verdict.measured.rest = now_ - step_begin_;
  acceptStep(verdict);
}

void Conductor::checkFit() {
  const double left = deadline_ ? *deadline_ - now_ : 0;
  complain(Reason::kNoTimeLeft,
           "the plan needs " + minutes(timeLeft()) + " more, but " + minutes(std::max(0.0, left)) +
               " are left; skip what matters least",
           deadline_ && started_ && !done() && timeLeft() > left);
  const double need = timeLeft(true) * bytes_per_second_;
  complain(Reason::kDiskNearlyFull,
           "the recordings that are left need " +
               settings::megabytesText(static_cast<std::uint64_t>(std::max(0.0, need))) + ", but " +
               settings::megabytesText(static_cast<std::uint64_t>(std::max(0.0, free_bytes_))) +
               " are left on the disk; make room",
           free_bytes_ >= 0 && need > free_bytes_);
}

// What would reject the next attempt as soon as it begins.
bool Conductor::isHindered() const {
  return steps_[step_].recorded &&
         complaints_.count(Reason::kScansLost) + complaints_.count(Reason::kNotRecorded) > 0;
}

bool Conductor::waitsForMount() const {
  return !done() && (resumed_ || steps_[step_].kind == StepKind::kMount);
}

// What the scans say about an attempt that the pressure accepts.
Verdict Conductor::withScans(Verdict verdict) {
  if (!steps_[step_].loads()) return verdict;
  const auto reject = [&verdict](Reason reason, const std::string& sentence) {
    return Verdict{reason, sentence, verdict.measured};
  };
  const unsigned fallen = dead_ - std::min(dead_, dead_known_);
  loaded_ = true;
  dead_known_ = dead_;
  complain(Reason::kTaxelFellOut, "", false);
  if (!steps_[step_].recorded) return verdict;
  if (fallen > 0) return reject(Reason::kTaxelFellOut, fallenText(fallen));
  for (const Reason reason : {Reason::kOtherSurface, Reason::kNotRecorded}) {
    const auto complaint = complaints_.find(reason);
    if (complaint != complaints_.end()) return reject(reason, complaint->second);
  }
  if (scans_ == 0) return reject(Reason::kScansLost, "no scan came");
  if (lost_ > kLostScans * (scans_ + lost_)) {
    return reject(Reason::kScansLost,
                  std::to_string(lost_) + " of " + std::to_string(scans_ + lost_) + " scans were lost");
  }
  return verdict;
}

void Conductor::complain(Reason reason, const std::string& sentence, bool holds) {
  if (holds)
    complaints_[reason] = sentence;
  else
    complaints_.erase(reason);
}

void Conductor::setHint() {
  const Verdict hint = watch_ && !recovering_ && !resumed_ ? watch_->hint() : Verdict{};
  for (const Reason reason : {Reason::kRestNotReached, Reason::kChamberStalled})
    complain(reason, hint.sentence, reason == hint.reason);
}

// ---- steps -----------------------------------------------------------------------------------------

void Conductor::acceptStep(const Verdict& verdict) {
  const bool loop = steps_[step_].kind == StepKind::kLoop;
  state_.steps[step_] = StepState::kAccepted;
  note(step_, StepState::kAccepted, verdict);
  goOn(loop);
}

void Conductor::rejectStep(const Verdict& verdict) {
  ++attempts_;
  last_rejected_ = verdict;
  recovering_ = true;
  note(step_, StepState::kOpen, verdict);
}

// An attempt that runs is rejected at once.
void Conductor::spoil(Reason reason, const std::string& sentence) {
  if (done() || !attemptRuns() || steps_[step_].kind == StepKind::kBreak) return;
  rejectStep({reason, sentence, {}});
}

void Conductor::hinder(Reason reason, const std::string& sentence) {
  complain(reason, sentence);
  spoil(reason, sentence);
}

void Conductor::note(std::size_t step, StepState state, const Verdict& verdict, bool mount_again) {
  ++revision_;
  state_.rejected += state == StepState::kOpen;
  outcomes_.push_back({step, state, verdict, mount_again});
  if (outcomes_.size() > kMostOutcomes) outcomes_.erase(outcomes_.begin());
  if (state == StepState::kSkipped || verdict.sentence.empty()) return;
  state_.remarks.push_back({step, verdict.reason, verdict.sentence});
  if (state_.remarks.size() > ConductorState::kMostRemarks) state_.remarks.erase(state_.remarks.begin());
}

// Goes to the first step that is open.
void Conductor::goOn(bool after_loop) {
  const auto open = std::find(state_.steps.begin(), state_.steps.end(), StepState::kOpen);
  step_ = static_cast<std::size_t>(open - state_.steps.begin());
  attempts_ = 0;
  last_rejected_ = {};
  resumed_ = false;
  if (started_) step_begin_ = judged_ ? std::max(rest_.since().value_or(now_), step_begin_) : now_;
  restartWatch(after_loop);
  surface(declared_);
  checkFit();
}

void Conductor::restartWatch(bool after_loop) {
  recovering_ = false;
  scans_ = lost_ = 0;
  watch_ = done() ? nullptr : watchOf(steps_[step_], step_begin_, after_loop);
}

std::vector<Outcome> Conductor::takeOutcomes() {
  return std::exchange(outcomes_, {});
}

ConductorState Conductor::state() const {
  ConductorState state = state_;
  state.time = now_;
  return state;
}

double Conductor::timeLeft(bool recorded) const {
  double left = 0;
  for (std::size_t s = 0; s < steps_.size(); ++s)
    left += state_.steps[s] == StepState::kOpen && (steps_[s].recorded || !recorded) ? steps_[s].duration : 0;
  return left;
}

}  // namespace fsr::session
