#pragma once

#include <map>
#include <string>

#include "fsr_pressure_map/simulation/simulation_settings.h"

namespace fsr::simulation {

/// Remarks on single values, by "effect.parameter": an interval, where a fitted value comes from.
using ValueRemarks = std::map<std::string, std::string>;

/// The settings as a YAML file that readSimulation() reads back into the same: every value spelt out, those
/// of the effects with unit and meaning. `head` becomes the comment at its begin, each of `remarks` one
/// behind its value.
std::string simulationText(const SimulationSettings& settings, const std::string& head = "",
                           const ValueRemarks& remarks = {});

}  // namespace fsr::simulation
