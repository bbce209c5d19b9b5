#pragma once

#include <string>

#include "fsr_pressure_map/discrepancy/discrepancy.h"
#include "fsr_pressure_map/simulation/session.h"

namespace fsr::planted {

/// A small rig on three surfaces, run at two speeds and with dwells; a scan every 0.4 s keeps it quick.
inline const char* const kTwoSpeeds = R"(
simulation: planted
seed: 7
matrix: {rows: 3, columns: 4}
board: {scan_rate: 2.5, transducer_rate: 2.5}
program:
  - cycles: {peak: 620000, rate: 40000, dwell_peak: 8, cycles: 5}
  - cycles: {peak: 620000, rate: 8000, dwell_peak: 8, cycles: 3}
  - cycles: {peak: 620000, rate: 40000, dwell_peak: 8, cycles: 3}
session:
  - {surface: flat, flat: true}
  - {surface: cylinder_9cm, cylinder: {radius: 0.09, axis: y}, pause: 300}
  - {surface: cylinder_5cm, cylinder: {radius: 0.05, axis: y}, pause: 300}
effects:
  static_curve: {conductance: 3.2e-4, exponent: 0.85, conductance_scatter: 0.05}
  bending_preload: {amplitude: 30000}
  bending_gain: {change: -0.15}
  white_noise: {absolute: 8}
  converter: {}
)";

/// The same rig under the paper's cycles on one surface.
inline const char* const kOneSurface = R"(
simulation: planted
seed: 7
matrix: {rows: 3, columns: 4}
board: {scan_rate: 2.5, transducer_rate: 2.5}
chamber: {cycles: 16}
session:
  - {surface: flat, flat: true}
effects:
  static_curve: {conductance: 3.2e-4, exponent: 0.85, conductance_scatter: 0.05}
  bending_preload: {amplitude: 30000}
  bending_gain: {change: -0.15}
  white_noise: {absolute: 8}
  converter: {}
)";

inline SimulationSettings simulation(const std::string& text, const std::string& more = "") {
  return readSimulation(Settings::fromText(text + more, "planted.yaml"));
}

/// What a rig with `more` records, against a simulation without it.
inline DiscrepancyProblem problem(const std::string& text, const std::string& more) {
  DiscrepancyProblem problem;
  problem.simulation = simulation(text);
  problem.recordings = simulateSession(simulation(text, more));
  problem.options.threads = 1;
  return problem;
}

}  // namespace fsr::planted
