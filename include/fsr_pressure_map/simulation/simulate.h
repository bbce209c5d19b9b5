#pragma once

#include <vector>

#include "fsr_pressure_map/dataset/recording.h"
#include "fsr_pressure_map/simulation/simulation_settings.h"

namespace fsr::simulation {

/// Runs all stations of the session of `settings`, one after the other. The sheet keeps its state from one
/// station to the next. Returns one recording for each station, as it would be read from a bag of that
/// station. Equal settings give equal recordings. Throws InputError where a station's program never ends.
std::vector<dataset::Recording> simulateSession(const SimulationSettings& settings);

}  // namespace fsr::simulation
