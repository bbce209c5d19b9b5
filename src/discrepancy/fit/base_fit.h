#pragma once

#include "discrepancy/fit/static_fit.h"
#include "discrepancy/samples/measured.h"

namespace fsr::discrepancy {

/// Fits the base parameters of the simulation to the recordings: static curve, preload and gain by bending
/// where they are enabled, and the scatter of the taxels. A user's matrix never has exactly the parameters
/// in the settings file. All other enabled effects keep their values.
simulation::SimulationSettings fitBase(const Measured& measured, const StaticFit& fit,
                                       const simulation::SimulationSettings& settings);

}  // namespace fsr::discrepancy
