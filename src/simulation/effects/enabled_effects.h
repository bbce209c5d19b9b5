#pragma once

#include "fsr_pressure_map/simulation/simulation_settings.h"

namespace fsr::simulation {

/// Whether an enabled effect draws new random numbers at each scan.
bool isNoise(const EnabledEffect& effect);
/// Whether it is the converter, which every chain has.
bool isConverter(const EnabledEffect& effect);

/// The settings without the effects that draw new random numbers at each scan.
SimulationSettings withoutNoise(SimulationSettings settings);

}  // namespace fsr::simulation
