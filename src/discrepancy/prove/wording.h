#pragma once

#include <optional>
#include <string>
#include <vector>

#include "discrepancy/decide/candidates.h"
#include "discrepancy/decide/decision.h"
#include "discrepancy/samples/measured.h"
#include "fsr_pressure_map/discrepancy/discrepancy.h"

namespace fsr::discrepancy {

/// "a, b and c".
std::string listText(const std::vector<std::string>& items, const std::string& last = " and ");
/// The names of effects that act together: "creep with hysteresis".
std::string idsOf(const std::vector<simulation::EnabledEffect>& effects);

/// The verdict in one sentence, with the number of effects tested.
std::string sentenceOf(const DiscrepancyReport& report);

/// Says that an explanation is weak on a part that its sizes were not fitted to: it closes the share `closed`
/// of the common trace there. NaN = nothing can be closed there.
std::string weakPartText(const std::string& part, double closed);

/// What a random course is. `a_cycle`: its step from one cycle to the next [share of full scale]. `alone`:
/// nothing else is left beyond chance.
std::string courseText(const std::string& id, double a_cycle, bool alone);

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
