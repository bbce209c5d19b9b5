#pragma once

#include <vector>

#include "discrepancy/samples/available_evidence.h"
#include "fsr_pressure_map/discrepancy/discrepancy.h"

namespace fsr::discrepancy {

/// Proposes the experiment that best distinguishes explanations. Each protocol that a rig can run is
/// simulated with each explanation. The distance between two explanations is measured after static curves and
/// sizes are fitted. The protocol with the largest smallest distance is chosen. Protocols that provide the
/// evidence that is missing for naming an effect alone are preferred. `floor`: noise of a reading [share of
/// full scale]. None for fewer than two explanations.
std::vector<NextExperiment> nextExperiment(
    const simulation::SimulationSettings& base,
    const std::vector<std::vector<simulation::EnabledEffect>>& explanations, const AvailableEvidence& at_hand,
    double floor);

}  // namespace fsr::discrepancy
