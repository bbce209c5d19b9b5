#pragma once

#include <string>
#include <vector>

#include "session/plan.h"

namespace fsr::session {

/// "3 h 12 min", "20 min", rounded up to whole minutes.
std::string timeText(double seconds);

/// One line: name, duration, mounts, surfaces.
std::string headline(const SessionPlan& plan);

/// What is needed, how long it takes, and what the recordings can and cannot tell, as far as the plan
/// decides. How well they tell it depends on the sheet.
std::string planReport(const SessionPlan& plan);

/// Ids of the effects that `discrepancy` could name alone.
std::vector<std::string> effectsToldBy(const SessionPlan& plan);

/// Sentences on what recordings of the plan cannot tell.
std::vector<std::string> limitsOf(const SessionPlan& plan);

/// A line for each step: time since the begin, mount, instruction.
std::string stepsText(const SessionPlan& plan);

}  // namespace fsr::session
