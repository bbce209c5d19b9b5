#pragma once

#include <string>

#include "fsr_pressure_map/simulation/effect_info.h"

namespace fsr::report {

/// Every effect of the library as text for a terminal: what it does, equation, source, parameters with
/// unit, usual and neutral value and ranges, and what whoever looks for it must know.
std::string effectListText();

/// One of them.
std::string effectText(const simulation::EffectInfo& info);

}  // namespace fsr::report
