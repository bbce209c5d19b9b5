#pragma once

#include "fsr_pressure_map/discrepancy/measured.h"
#include "fsr_pressure_map/discrepancy/static_fit.h"

namespace fsr {

/// The simulation with its base parameters as the recordings have them: static curve, preload and gain
/// by bending as far as they are enabled, and the scatter of the taxels. A user's matrix is never the
/// one in the file. What is enabled besides keeps its values.
SimulationSettings fitBase(const Measured& measured, const StaticFit& fit,
                           const SimulationSettings& settings);

}  // namespace fsr
