#pragma once

#include "discrepancy/decide/candidates.h"
#include "discrepancy/decide/decision.h"
#include "discrepancy/samples/measured.h"
#include "fsr_pressure_map/discrepancy/discrepancy.h"

namespace fsr::discrepancy {

/// Writes into `report` what holds for the effects that were not found: which were tested, which these
/// recordings cannot show, and the answer about each effect that the user asks for. If nothing was found and
/// the recordings cannot show one of the latter, that is the verdict.
void tellOfOthers(const DiscrepancyProblem& problem, const Measured& measured, const Candidates& candidates,
                  const Decision& decision, DiscrepancyReport& report);

}  // namespace fsr::discrepancy
