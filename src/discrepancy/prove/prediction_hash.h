#pragma once

#include "fsr_pressure_map/discrepancy/discrepancy.h"

namespace fsr::discrepancy {

/// Whether prediction.hash is the hash of this prediction and this simulation.
///
/// Three forms are accepted. hashOf() gives the third where the prediction has weights or a spread, and the
/// second where it has neither, as in files of earlier versions. Files of early development versions hold the
/// first form, which covers the effects (values to 9 digits), the size of the matrix and the predicted size,
/// but nothing else of the simulation. A file with the first form is therefore still checked, but not as
/// completely.
bool hasItsHash(const Prediction& prediction, const simulation::SimulationSettings& simulation);

/// The first form of the hash, for reading old files.
std::string firstHashOf(const Prediction& prediction, const simulation::SimulationSettings& simulation);

}  // namespace fsr::discrepancy
