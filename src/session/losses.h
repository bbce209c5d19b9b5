#pragma once

#include <string>
#include <vector>

#include "session/plan.h"
#include "session/prospects.h"

namespace fsr::session {

/// Sentences on what recordings cannot tell.
std::vector<std::string> limitsOf(const Prospects& prospects);

/// Sentences on what `less` cannot tell, but `more` can.
std::vector<std::string> lossesBetween(const Prospects& more, const Prospects& less);

/// A piece that can be left out of a plan.
struct Cut {
  std::string what;                 ///< e.g. "without cylinder_5cm"
  double saved = 0;                 ///< time [s]
  std::vector<std::string> losses;  ///< sentences; empty = nothing that the code knows of
};

/// Each piece of the plan, left out alone: a surface, the remounts, the repetition of the first surface, a
/// part of the program, half of the cycles, a break, the conditioning, the thermometer. The losses are the
/// difference of prospectsOf() with and without it.
std::vector<Cut> cutsOf(const SessionPlan& plan, const Prospects& prospects);

/// "3 cycles to 620 kPa at 17 kPa/s, dwells of 1 s".
std::string partWords(const simulation::ProgramPart& part);

/// Breaks behind the last mount are moved before it, and dropped where there is one mount only.
void fitBreaks(SessionPlan& plan);

}  // namespace fsr::session
