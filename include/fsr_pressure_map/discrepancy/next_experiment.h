#pragma once

#include <vector>

#include "fsr_pressure_map/discrepancy/discrepancy.h"
#include "fsr_pressure_map/discrepancy/evidence.h"

namespace fsr {

/// What to do at the rig to tell explanations apart: each protocol that a rig can run is simulated with
/// each of them, and the one is taken that keeps the nearest two farthest apart once static curves and
/// sizes are fitted; protocols that bring what was lacking to name an effect alone come first. `floor`: noise
/// of a reading [share of full scale]. None for fewer than two explanations.
std::vector<NextExperiment> nextExperiment(const SimulationSettings& base,
                                           const std::vector<std::vector<EnabledEffect>>& explanations,
                                           const EvidenceAtHand& at_hand, double floor);

}  // namespace fsr
