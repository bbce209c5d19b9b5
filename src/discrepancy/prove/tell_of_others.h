#pragma once

#include <optional>
#include <string>
#include <vector>

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

/// Where nothing was found in recordings that are fit for nothing, the verdict becomes kNotIdentifiable, its
/// sentence gives the reason, and no effect counts as excluded.
void abstainIfUnfit(const std::vector<dataset::Recording>& recordings, DiscrepancyReport& report);

/// The report on recordings with too few cycles to compare, for `reason`: answers to the user's questions,
/// and nothing else. None where there is no question about an effect that is looked for.
std::optional<DiscrepancyReport> answersWithoutCycles(const DiscrepancyProblem& problem,
                                                      const std::string& reason);

}  // namespace fsr::discrepancy
