#pragma once

#include <vector>

#include "discrepancy/samples/measured.h"
#include "fsr_pressure_map/simulation/simulation_settings.h"

namespace fsr::discrepancy {

/// Computes the pressure errors that effects cause in use. The effects are those in `with` but not in
/// `without`. The sheet is read through static curves that were fitted to these recordings. The result holds
/// the largest error in each of three situations: a ramp over the recorded range, the last of several steps
/// of 0.6 s, and ten minutes of standing. Steps and standing reach half the highest pressure. The worst
/// surface counts; on each, the situations reach up to the highest pressure that was recorded there.
/// Pressures below a tenth of the situation's peak do not count, nor those where the static curve is so flat
/// that its reading tells nothing (a slope below a twentieth of the usual one), nor readings beyond the ends
/// of the curve. `closed`: share of the squared error that a model with these effects removes. The error that
/// remains is the cost after.
std::vector<GapInUse> costsInUse(const Measured& measured, const simulation::SimulationSettings& without,
                                 const simulation::SimulationSettings& with, double closed);

}  // namespace fsr::discrepancy
