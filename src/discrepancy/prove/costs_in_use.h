#pragma once

#include <vector>

#include "discrepancy/samples/measured.h"
#include "fsr_pressure_map/simulation/simulation_settings.h"

namespace fsr::discrepancy {

/// What it costs to read the sheet through static curves that were fitted to these recordings, while
/// effects that `with` has beyond `without` act: the largest error in a ramp over the recorded range, in one
/// of many steps of 0.6 s, and in ten minutes of standing, the latter two at half the highest pressure. Of
/// all surfaces the worst; pressures below a tenth of the situation's peak do not count. `closed`: share of
/// the squared error that a model with these effects takes away; what it leaves is the cost after.
std::vector<GapInUse> costsInUse(const Measured& measured, const simulation::SimulationSettings& without,
                                 const simulation::SimulationSettings& with, double closed);

}  // namespace fsr::discrepancy
