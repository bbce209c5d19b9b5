#include "conductor/day_record.h"

#include <filesystem>

#include "conductor/coverage_svg.h"
#include "conductor/session_files.h"
#include "session_plan/losses.h"
#include "session_plan/plan_report.h"
#include "session_plan/prospects.h"

namespace fsr::conductor {

using report::DayMount;
using report::DayStep;
using report::StepFate;
using session_plan::SessionStep;
using session_plan::StepKind;

namespace {

StepFate fateOf(StepState state) {
  if (state == StepState::kAccepted) return StepFate::kAccepted;
  return state == StepState::kSkipped ? StepFate::kSkipped : StepFate::kOpen;
}

DayStep dayStep(const SessionStep& step, StepState state) {
  DayStep day;
  day.kind = name(step.kind);
  day.text = session_plan::instruction(step);
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

report::DayReport dayRecord(const session_plan::SessionPlan& plan, const ConductorState& state,
                            const std::string& folder) {
  const Conductor session(plan, state);  // refuses the state of another plan
  report::DayReport day;
  day.plan = plan.name;
  day.headline = session_plan::headline(plan);
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
  day.plan_limits = session_plan::limitsOf(session_plan::prospectsOf(plan));
  return day;
}

}  // namespace fsr::conductor
