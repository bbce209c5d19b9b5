#pragma once

#include <vector>

#include "discrepancy/samples/available_evidence.h"
#include "fsr_pressure_map/discrepancy/discrepancy.h"

namespace fsr::discrepancy {

/// What to do at the rig to tell explanations apart: each protocol that a rig can run is simulated with
/// each of them, and the one is taken that keeps the nearest two farthest apart once static curves and
/// sizes are fitted; protocols that bring what was lacking to name an effect alone come first. `floor`: noise
/// of a reading [share of full scale]. None for fewer than two explanations.
std::vector<NextExperiment> nextExperiment(
    const simulation::SimulationSettings& base,
    const std::vector<std::vector<simulation::EnabledEffect>>& explanations, const AvailableEvidence& at_hand,
    double floor);

}  // namespace fsr::discrepancy
