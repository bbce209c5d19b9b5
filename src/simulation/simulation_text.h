#pragma once

#include <map>
#include <string>

#include "fsr_pressure_map/simulation/simulation_settings.h"

namespace fsr::simulation {

/// Remarks on single values, by "effect.parameter": an interval, where a fitted value comes from.
using ValueRemarks = std::map<std::string, std::string>;

/// The settings as a YAML file, from which readSimulation() reads the same settings. Every value is written
/// out, those of effects with unit and meaning. `head` becomes a comment at the begin of the file, and each
/// of `remarks` a comment behind its value.
std::string simulationText(const SimulationSettings& settings, const std::string& head = "",
                           const ValueRemarks& remarks = {});

}  // namespace fsr::simulation
