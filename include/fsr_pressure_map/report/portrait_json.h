#pragma once

#include <string>

#include "fsr_pressure_map/simulation/portrait.h"

namespace fsr {

/// A portrait as JSON, for scripts/plot_simulation.py: pressures in kPa, readings in per cent of full scale.
std::string portraitJson(const Portrait& portrait);

}  // namespace fsr
