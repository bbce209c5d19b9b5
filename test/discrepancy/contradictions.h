#pragma once

#include <string>
#include <vector>

#include "fsr_pressure_map/discrepancy/discrepancy.h"

namespace test_support {

/// Statements of a discrepancy report that contradict each other, one sentence each. Empty = none does.
std::vector<std::string> contradictions(const fsr::discrepancy::DiscrepancyReport& report);

}  // namespace test_support
