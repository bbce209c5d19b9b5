#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "discrepancy/samples/measured.h"
#include "simulation/rig.h"
#include "simulation/session.h"
#include "simulation/settings_text.h"

namespace fsr::discrepancy::planted {

/// A rig of twelve taxels as YAML. `chamber`: its program or its cycles. It ends with its effects, to which a
/// test adds more. A scan every 0.4 s keeps the tests fast.
inline std::string rig(const std::string& chamber, const std::string& session,
                       const std::string& noise = "{absolute: 8}", int seed = 7) {
  return "simulation: planted\nseed: " + std::to_string(seed) +
         "\nmatrix: {rows: 3, columns: 4}\nboard: {scan_rate: 2.5, transducer_rate: 2.5}\n" + chamber +
         "session:\n" + session + R"(effects:
  static_curve: {conductance: 3.2e-4, exponent: 0.85, conductance_scatter: 0.05}
  bending_preload: {amplitude: 30000}
  bending_gain: {change: -0.15}
  converter: {}
  white_noise: )" +
         noise + "\n";
}

inline const std::string kFlat = "  - {surface: flat, flat: true}\n";
inline const std::string kTwoSurfaces =
    kFlat + "  - {surface: cylinder_5cm, cylinder: {radius: 0.05, axis: y}, pause: 300}\n";

/// A small rig on three surfaces. It runs at two speeds and with dwells.
inline const std::string kTwoSpeeds = rig(R"(program:
  - cycles: {peak: 620000, rate: 40000, dwell_peak: 8, cycles: 5}
  - cycles: {peak: 620000, rate: 8000, dwell_peak: 8, cycles: 3}
  - cycles: {peak: 620000, rate: 40000, dwell_peak: 8, cycles: 3}
)",
                                          R"(  - {surface: flat, flat: true}
  - {surface: cylinder_9cm, cylinder: {radius: 0.09, axis: y}, pause: 300}
  - {surface: cylinder_5cm, cylinder: {radius: 0.05, axis: y}, pause: 300}
)");

/// The same rig with another matrix. In twelve taxels a line of three is too short to tell from three taxels.
inline std::string withMatrix(int rows, int columns) {
  const std::string small = "{rows: 3, columns: 4}";
  std::string rig = kTwoSpeeds;
  return rig.replace(rig.find(small), small.size(),
                     "{rows: " + std::to_string(rows) + ", columns: " + std::to_string(columns) + "}");
}

/// The same rig with another program of the chamber: YAML, one line for each step.
inline std::string withProgram(const std::string& program) {
  std::string rig = kTwoSpeeds;
  const std::size_t first = rig.find("  - cycles:"), last = rig.find("session:");
  return rig.replace(first, last - first, program);
}

/// The cycles of the paper on one surface, and on two: one speed, no dwells.
inline const std::string kOneSurface = rig("chamber: {cycles: 16}\n", kFlat);
inline const std::string kOneSpeed = rig("chamber: {cycles: 8}\n", kTwoSurfaces);

/// Four taxels that are fast to simulate. The caller appends the session.
inline const std::string kFourTaxels = R"(
simulation: rig
seed: 7
matrix: {rows: 2, columns: 2}
board: {scan_rate: 2, transducer_rate: 2}
chamber: {cycles: 4}
effects:
  static_curve: {conductance: 3.2e-4, exponent: 0.85}
  bending_preload: {amplitude: 30000}
  bending_gain: {change: -0.15}
  converter: {}
session:
)";

inline simulation::SimulationSettings simulation(const std::string& text, const std::string& more = "") {
  return simulation::readSimulation(settings::Settings::fromText(text + more, "planted.yaml"));
}

/// Recordings of a rig with the effects in `more`, and a simulation without these effects.
inline DiscrepancyProblem problem(const std::string& text, const std::string& more) {
  DiscrepancyProblem problem;
  problem.simulation = simulation(text);
  problem.recordings = simulation::simulateSession(simulation(text, more));
  problem.options.threads = 1;
  return problem;
}

/// A reading that is changed.
struct Changed {
  std::size_t recording, scan, taxel;
  double time;   ///< since the first scan of the first recording [s]
  double whole;  ///< duration of all recordings [s]
  double loads;  ///< path of the pressure in this recording / that of a cycle to the highest one
  double count;
};

/// A rig whose readings are changed after the simulation: `count` is asked for each of them.
template <typename Count>
DiscrepancyProblem problemReading(const std::string& text, Count count) {
  DiscrepancyProblem problem = planted::problem(text, "");
  auto& recordings = problem.recordings;
  const auto since = [&](const dataset::Recording& r, double time) {
    return 1e-9 * static_cast<double>(r.start_ns - recordings.front().start_ns) + time;
  };
  const double whole = since(recordings.back(), recordings.back().time.back());
  for (std::size_t r = 0; r < recordings.size(); ++r) {
    dataset::Recording& recording = recordings[r];
    const std::size_t taxels = recording.layout.size.taxels();
    const double peak = *std::max_element(recording.pressure.begin(), recording.pressure.end());
    double path = 0;
    for (std::size_t i = 0; i < recording.scans(); ++i) {
      if (i > 0) path += std::abs(recording.pressure[i] - recording.pressure[i - 1]) / (2 * peak);
      for (std::size_t t = 0; t < taxels; ++t) {
        auto& now = recording.counts[i * taxels + t];
        const double changed =
            count(Changed{r, i, t, since(recording, recording.time[i]), whole, path, double(now)});
        now = static_cast<std::uint16_t>(std::clamp(std::lround(changed), 0L, 4095L));
      }
    }
  }
  return problem;
}

/// Reads out the matrix under the pressures of `felt` instead of those of the problem's recordings.
inline void readOut(const std::vector<dataset::Recording>& felt, DiscrepancyProblem& problem) {
  simulation::DrivenRig rig(problem.simulation);
  for (std::size_t r = 0; r < felt.size(); ++r) {
    rig.run(felt[r], [&](std::size_t scan, const simulation::SensorChain& chain) {
      const auto& counts = chain.counts();
      std::copy(counts.begin(), counts.end(),
                problem.recordings[r].counts.begin() + static_cast<std::ptrdiff_t>(scan * counts.size()));
    });
  }
}

/// A rig whose matrix feels the chamber's pressure plus `more` [Pa]. `more` is a function of the pressure, as
/// a share of 620 kPa, of the direction, and of the rate [Pa/s]. It plants forms that are not in the library.
template <typename More>
DiscrepancyProblem problemFeeling(const std::string& text, More more) {
  DiscrepancyProblem problem = planted::problem(text, "");
  const Measured measured = admit(problem);
  std::vector<dataset::Recording> felt = problem.recordings;
  for (std::size_t m = 0; m < measured.samples(); ++m) {
    const double share = std::clamp(measured.pressure[m] / 620e3, 0.0, 1.0);
    dataset::Recording& recording = felt[measured.visits[measured.visit[m]].recording];
    recording.pressure[measured.first_scan[m]] += more(share, measured.direction[m], measured.rate[m]);
  }
  readOut(felt, problem);
  return problem;
}

/// A loop whose branches are far apart at low pressure and cross at high pressure. Its friction changes sign,
/// which a play operator cannot do.
inline DiscrepancyProblem crossedLoop() {
  constexpr double kPi = 3.14159265358979323846;
  return problemFeeling(kTwoSpeeds, [](double share, int direction, double) {
    return -direction * 20e3 * (std::sin(kPi * share) + std::sin(2 * kPi * share));
  });
}

}  // namespace fsr::discrepancy::planted
