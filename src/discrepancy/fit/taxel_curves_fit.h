#pragma once

#include <string>

#include "discrepancy/samples/measured.h"

namespace fsr::discrepancy {

/// The simulation with the curves of single taxels (see TaxelCurves): what it lacks of the readings, by
/// surface and pressure, when it is driven through the recordings. Fitted on the cycles that are not held
/// out; `file` is the name that the settings give the table.
simulation::SimulationSettings withTaxelCurves(const Measured& measured,
                                               const simulation::SimulationSettings& simulation,
                                               const std::string& file);

/// How far a simulation, driven through the recordings, is from them: rms over the scans of the hold-out
/// cycles and the used taxels, its own noise left out [share of full scale]. NaN where no cycle is shown.
double simulatedGap(const Measured& measured, const simulation::SimulationSettings& simulation);

}  // namespace fsr::discrepancy
