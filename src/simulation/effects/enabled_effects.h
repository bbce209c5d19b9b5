#pragma once

#include "fsr_pressure_map/simulation/simulation_settings.h"

namespace fsr::simulation {

/// The converter, without which no chain runs.
const EnabledEffect& converterOf(const SimulationSettings& settings);

/// The settings without the effects that draw new random numbers at each scan.
SimulationSettings withoutNoise(SimulationSettings settings);

/// The same without those whose course in a recording no simulation repeats (EffectInfo::by_chance), and
/// without the random walks of the others.
SimulationSettings withoutChance(SimulationSettings settings);

}  // namespace fsr::simulation
