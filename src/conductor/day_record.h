#pragma once

#include <string>

#include "conductor/conductor.h"
#include "report/day/day_report.h"

namespace fsr::conductor {

/// What the plan, the state of its session and the names of the bags in `folder` say for the report of the
/// day: each step, coverage and the limits of the plan. The parts of the tools stay empty. Throws InputError
/// where the state belongs to another plan.
report::DayReport dayRecord(const session_plan::SessionPlan& plan, const ConductorState& state,
                            const std::string& folder);

}  // namespace fsr::conductor
