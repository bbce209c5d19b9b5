#pragma once

#include <string>
#include <vector>

#include "fsr_pressure_map/discrepancy/discrepancy.h"

namespace fsr::discrepancy {

/// "a, b and c".
std::string listText(const std::vector<std::string>& items, const std::string& last = " and ");

/// The verdict in one sentence, with the number of effects tested.
std::string sentenceOf(const DiscrepancyReport& report);

}  // namespace fsr::discrepancy
