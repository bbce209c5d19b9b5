#pragma once

#include <string>

#include "simulation/portrait.h"

namespace fsr::report {

/// A portrait of a simulation as JSON for the figures: pressures in kPa, readings in per cent of full scale.
std::string portraitJson(const simulation::Portrait& portrait);

}  // namespace fsr::report
