// What a person says to the conductor, and what is told to a person.

#include <algorithm>

#include "session/conductor.h"

namespace fsr::session {

namespace {

constexpr unsigned kManyAttempts = 3;

std::string mountText(const SessionStep& step) {
  return "mount " + std::to_string(step.mount) + " on " + step.surface;
}

std::string stepText(const SessionStep& step) {
  if (step.kind == StepKind::kMount) return mountText(step);
  return name(step.kind) + " " + std::to_string(step.number) + " of " + std::to_string(step.of) + ", " +
         mountText(step);
}

Verdict byHand(const std::string& sentence) {
  return {Reason::kByHand, sentence.empty() ? "by a person" : sentence, {}};
}

}  // namespace

Answer Conductor::confirm() {
  if (!waitsForMount()) return {false, "nothing is to be confirmed; now: " + text()};
  const std::string sentence =
      "the sheet lies on " + steps_[step_].surface + ", mount " + std::to_string(steps_[step_].mount);
  rest_.restart();
  if (!resumed_) {
    dead_known_ = dead_;
    rest_counts_.restart();
    complain(Reason::kMountsDisagree, "", false);
    acceptStep({});
  } else {
    resumed_ = false;
    step_begin_ = now_;
    restartWatch();
    surface(declared_);
  }
  complain(Reason::kNotConfirmed, "", false);
  return {true, sentence};
}

Answer Conductor::accept() {
  if (done() || attempts_ == 0) return {false, "no attempt at the present step was rejected"};
  if (attemptRuns()) return {false, "the next attempt runs already; reject it or wait for its end"};
  if (waitsForMount()) return confirm();
  Verdict verdict;
  verdict.sentence = "accepted by hand, although: " + last_rejected_.sentence;
  verdict.measured = last_rejected_.measured;
  const std::string sentence = stepText(steps_[step_]) + " " + verdict.sentence;
  acceptStep(verdict);
  return {true, sentence};
}

Answer Conductor::reject(const std::string& reason) {
  if (done()) return {false, "the session is over; record what should be repeated in another one"};
  if (resumed_) {
    const unsigned mount = steps_[step_].mount;
    for (std::size_t s = 0; s < steps_.size(); ++s) {
      if (steps_[s].mount == mount) state_.steps[s] = StepState::kOpen;
    }
    note(step_, StepState::kOpen, byHand("the sheet has left the surface; the mount begins again"), true);
    goOn();
    return {true, mountText(steps_[step_]) + " begins again"};
  }
  if (attemptRuns()) {
    rejectStep(byHand(reason));
    return {true, stepText(steps_[step_]) + " is rejected"};
  }
  const bool same = step_ > 0 && steps_[step_ - 1].mount == steps_[step_].mount;
  if (!same || state_.steps[step_ - 1] != StepState::kAccepted)
    return {false, "nothing is to be rejected: no attempt runs, and none was accepted before on this mount"};
  const std::size_t before = step_ - 1;
  state_.steps[before] = StepState::kOpen;
  goOn();
  if (steps_[before].kind == StepKind::kMount) {
    note(before, StepState::kOpen, byHand(reason), true);
  } else {
    rejectStep(byHand(reason));
  }
  return {true, stepText(steps_[before]) + " is taken back"};
}

Answer Conductor::skip() {
  if (done()) return {false, "the session is over; nothing is left to skip"};
  const SessionStep step = steps_[step_];
  const std::size_t at = step_;
  const bool mount = waitsForMount();
  const auto open = std::count(state_.steps.begin(), state_.steps.end(), StepState::kOpen);
  if (mount)
    skipMount();
  else
    state_.steps[step_] = StepState::kSkipped;
  note(at, StepState::kSkipped, byHand("skipped"));
  const auto skipped = open - std::count(state_.steps.begin(), state_.steps.end(), StepState::kOpen);
  goOn();
  recovering_ = !done() && watch_ && judged_ && !canBegin(steps_[step_], last_judged_.pressure);
  return {true,
          (mount ? mountText(step) + ": " + std::to_string(skipped) + " steps are" : stepText(step) + " is") +
              " skipped"};
}

// A break behind the mount stays.
void Conductor::skipMount() {
  const unsigned mount = steps_[step_].mount;
  for (std::size_t s = 0; s < steps_.size(); ++s) {
    if (steps_[s].mount == mount && steps_[s].kind != StepKind::kBreak && state_.steps[s] == StepState::kOpen)
      state_.steps[s] = StepState::kSkipped;
  }
}

std::string Conductor::text() const {
  if (done()) {
    const auto count = [this](StepState state) {
      return std::to_string(std::count(state_.steps.begin(), state_.steps.end(), state));
    };
    return "The session is over: " + count(StepState::kAccepted) + " steps accepted, " +
           count(StepState::kSkipped) + " skipped, " + std::to_string(state_.rejected) +
           (state_.rejected == 1 ? " attempt rejected." : " attempts rejected.");
  }
  const SessionStep& step = steps_[step_];
  if (resumed_) {
    return "The session goes on: confirm that the sheet has stayed on " + step.surface + ", mount " +
           std::to_string(step.mount) + ". If not, reject: the mount begins again.";
  }
  std::string text = session::instruction(step);
  if (step.kind == StepKind::kMount) text += " Then confirm.";
  if (recovering_)
    text = "Vent to " + (step.kind == StepKind::kLoop ? kPaText(step.low) : std::string("rest")) +
           (attempts_ > 0 ? ", then again: " : ", then: ") + text;
  if (attempts_ >= kManyAttempts) {
    text += " " + std::to_string(attempts_) +
            " attempts were rejected: skip this step, or accept the last attempt, to go on.";
  }
  return text;
}

std::string Conductor::remark() const {
  std::string remark;
  const auto add = [&remark](const std::string& sentence) {
    if (!sentence.empty() && remark.find(sentence) == std::string::npos)
      remark += (remark.empty() ? "" : "; ") + sentence;
  };
  for (const auto& complaint : complaints_) add(complaint.second);
  if (attempts_ > 0) add("last attempt rejected: " + last_rejected_.sentence);
  return remark;
}

Instruction Conductor::instruction() const {
  SessionStep step;
  step.kind = StepKind::kDone;
  step.mount = step.number = step.of = 0;
  if (!done() && !resumed_) step = steps_[step_];
  if (resumed_) {
    step.kind = StepKind::kMount;
    step.surface = steps_[step_].surface;
    step.mount = steps_[step_].mount;
  }
  return {step,     plan_.name,     std::min(step_ + 1, steps_.size()), steps_.size(), text(),
          remark(), waitsForMount()};
}

}  // namespace fsr::session
