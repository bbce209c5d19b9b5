#pragma once

#include <string>

#include "discrepancy/samples/measured.h"

namespace fsr::discrepancy {

/// Returns the simulation with curves of single taxels added (see TaxelCurves). The curves are the readings
/// minus the simulation driven through the recordings, by surface and pressure. They are fitted to the cycles
/// that are not held out. `file` is the name of the table in the settings.
simulation::SimulationSettings withTaxelCurves(const Measured& measured,
                                               const simulation::SimulationSettings& simulation,
                                               const std::string& file);

/// Difference between the recordings and a simulation driven through them without its own noise: rms over the
/// scans of the hold-out cycles and the used taxels [share of full scale]. NaN if there is no hold-out cycle.
double simulatedGap(const Measured& measured, const simulation::SimulationSettings& simulation);

}  // namespace fsr::discrepancy
