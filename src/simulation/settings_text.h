#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "fsr_pressure_map/simulation/simulation_settings.h"
#include "settings/settings.h"

namespace fsr::simulation {

/// As readSimulationFile(), of settings that were read already. `library`: the effects that may be enabled;
/// none = those of this package.
SimulationSettings readSimulation(const settings::Settings& settings,
                                  std::shared_ptr<const EffectLibrary> library = nullptr);

/// Reads the mapping `peak`, `rate` (of filling and venting) or `fill_rate` and `vent_rate`, `dwell_peak`,
/// `dwell_rest`, `cycles`. A missing key keeps the value of `defaults`. Throws InputError.
ChamberProtocol readChamberProtocol(const settings::Settings& settings, const ChamberProtocol& defaults = {});

/// The protocol as a YAML mapping on one line, as readChamberProtocol() reads it.
std::string protocolText(const ChamberProtocol& protocol);

/// Reads a list of parts, each a mapping with one key:
///
///     - cycles: {peak: 620000, rate: 17000, ...}                      # see readChamberProtocol()
///     - hold: {pressure: 300000, rate: 100000, duration: 300}
///     - loops: {low: 200000, high: 400000, rate: 17000, loops: 4}
///     - rest: {rate: 17000, duration: 600}
///
/// Throws InputError that names what is missing or out of range, or the part that follows cycles that never
/// end.
ChamberProgram readChamberProgram(const std::vector<settings::Settings>& parts);

/// The part as readChamberProgram() reads it, on one line, without the leading dash.
std::string programText(const ProgramPart& part);

/// Reads the mapping `room: [{time: 0, temperature: 23}, ...]` (or one number), `heating`, `cooling`.
/// Throws InputError.
ChamberClimate readChamberClimate(const settings::Settings& settings);

/// Reads the mapping `disc: {x, y, radius}` or `edge: {x, y, angle}`; x and y are 0 where missing.
/// Throws InputError.
LoadPattern readLoadPattern(const settings::Settings& settings);

/// Remarks on single values, by "effect.parameter": an interval, where a fitted value comes from.
using ValueRemarks = std::map<std::string, std::string>;

/// The settings as a YAML file, from which readSimulation() reads the same settings. Every value is written
/// out, those of effects with unit and meaning. `head` becomes a comment at the begin of the file, and each
/// of `remarks` a comment behind its value.
std::string simulationText(const SimulationSettings& settings, const std::string& head = "",
                           const ValueRemarks& remarks = {});

}  // namespace fsr::simulation
