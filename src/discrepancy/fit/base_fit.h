#pragma once

#include "discrepancy/fit/static_fit.h"
#include "discrepancy/samples/measured.h"

namespace fsr::discrepancy {

/// The simulation with its base parameters as the recordings have them: static curve, preload and gain
/// by bending as far as they are enabled, and the scatter of the taxels. A user's matrix is never the
/// one in the file. What is enabled besides keeps its values.
simulation::SimulationSettings fitBase(const Measured& measured, const StaticFit& fit,
                                       const simulation::SimulationSettings& settings);

}  // namespace fsr::discrepancy
