#pragma once

#include <string>

#include "fsr_pressure_map/simulation/effect_info.h"

namespace fsr::report {

/// All effects of the library as text for a terminal. Each has its summary, equation, source, parameters with
/// unit, usual and neutral value and ranges, and what is needed to find it in recordings.
std::string effectListText();

/// The same for one effect.
std::string effectText(const simulation::EffectInfo& info);

}  // namespace fsr::report
