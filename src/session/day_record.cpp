#include "session/day_report.h"

#include <filesystem>

#include "session/coverage.h"
#include "session/plan_report.h"
#include "session/session_files.h"

namespace fsr::session {

namespace {

StepFate fateOf(StepState state) {
  if (state == StepState::kAccepted) return StepFate::kAccepted;
  return state == StepState::kSkipped ? StepFate::kSkipped : StepFate::kOpen;
}

DayStep dayStep(const SessionStep& step, StepState state) {
  DayStep day;
  day.kind = name(step.kind);
  day.text = session::instruction(step);
  day.fate = fateOf(state);
  day.conditioning = step.kind == StepKind::kCondition;
  return day;
}

void addRemark(DayStep& step, const StepRemark& remark) {
  const bool rejected = remark.reason != Reason::kNone;
  step.rejected += rejected ? 1 : 0;
  step.remarks.push_back((rejected ? "rejected (" + name(remark.reason) + "): " : std::string()) +
                         remark.sentence);
}

}  // namespace

DayReport dayRecord(const SessionPlan& plan, const ConductorState& state, const std::string& folder) {
  const Conductor session(plan, state);  // refuses the state of another plan
  DayReport day;
  day.plan = plan.name;
  day.headline = headline(plan);
  day.folder = std::filesystem::absolute(folder).lexically_normal().string();
  day.rejected = state.rejected;
  std::vector<DayStep> steps;
  for (std::size_t s = 0; s < state.steps.size(); ++s)
    steps.push_back(dayStep(session.steps()[s], state.steps[s]));
  for (const StepRemark& remark : state.remarks) addRemark(steps[remark.step], remark);
  for (std::size_t s = 0; s < steps.size(); ++s) {
    const SessionStep& step = session.steps()[s];
    if (day.mounts.empty() || day.mounts.back().number != step.mount) {
      const std::string stem = bagStem(plan.name, step.mount, step.surface);
      day.mounts.push_back({step.mount, step.surface, {}, bagsOfMount(folder, stem)});
    }
    day.mounts.back().steps.push_back(std::move(steps[s]));
  }
  day.coverage = coverageSvg(coverageOf(plan, session.steps(), state.steps));
  day.plan_limits = limitsOf(plan);
  return day;
}

}  // namespace fsr::session
