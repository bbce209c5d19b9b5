#pragma once

#include <string>

#include "fsr_pressure_map/simulation/effect_info.h"
#include "simulation/portrait.h"

namespace fsr::report {

/// All effects of the library as text for a terminal. Each has its summary, equation, source, parameters with
/// unit, usual and neutral value and ranges, and what is needed to find it in recordings.
std::string effectListText();

/// The same for one effect.
std::string effectText(const simulation::EffectInfo& info);

/// A portrait of a simulation as JSON for the figures: pressures in kPa, readings in per cent of full scale.
std::string portraitJson(const simulation::Portrait& portrait);

}  // namespace fsr::report
