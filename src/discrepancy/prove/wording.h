#pragma once

#include <string>
#include <vector>

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

}  // namespace fsr::discrepancy
