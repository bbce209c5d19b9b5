#pragma once

#include <string>
#include <vector>

#include "session/plan.h"

namespace fsr::session {

/// "3 h 12 min", "20 min", rounded up to whole minutes.
std::string timeText(double seconds);

/// One line: name, duration, mounts, surfaces.
std::string headline(const SessionPlan& plan);

/// What is needed, how long it takes, what the recordings can and cannot tell, and what each cut costs.
std::string planReport(const SessionPlan& plan);

/// What `plan` lacks beside a longer one, as sentences; empty = nothing.
std::vector<std::string> lacksBeside(const SessionPlan& whole, const SessionPlan& plan);

/// A line for each step: time since the begin, mount, instruction.
std::string stepsText(const SessionPlan& plan);

}  // namespace fsr::session
