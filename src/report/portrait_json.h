#pragma once

#include <string>

#include "simulation/portrait.h"

namespace fsr::report {

/// A portrait as JSON, for scripts/plot_simulation.py: pressures in kPa, readings in per cent of full scale.
std::string portraitJson(const simulation::Portrait& portrait);

}  // namespace fsr::report
