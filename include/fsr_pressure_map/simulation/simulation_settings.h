#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fsr_pressure_map/matrix/layout.h"
#include "fsr_pressure_map/settings/settings.h"
#include "fsr_pressure_map/simulation/chamber_protocol.h"
#include "fsr_pressure_map/simulation/effect.h"
#include "fsr_pressure_map/simulation/transducer.h"

namespace fsr {

/// The simulated board, as far as it is no effect.
struct SimulatedBoard {
  std::string serial = "SIM-0001";
  std::string firmware = "1.0.0";
  std::string model = "simulated";
  double scan_rate = 10;        ///< [Hz]
  double scan_duration = 0;     ///< first to last taxel [s], 0 = all at once
  double transducer_rate = 10;  ///< [Hz], 0 = no transducer on this link
  double temperature = 23;      ///< of the chamber [degree Celsius]
};

/// Throws InputError where a scan takes longer than the time from scan to scan; `origin` stands where
/// messages name the file.
void validate(const SimulatedBoard& board, const std::string& origin);

/// One effect that is enabled, with all its parameters.
struct EnabledEffect {
  std::string id;
  EffectValues values;
};

/// A simulated rig: config/simulation/*.yaml.
struct SimulationSettings {
  std::string origin;  ///< the file, for messages
  std::string name;
  std::uint64_t seed = 1;
  Layout layout{{7, 10}, 0.010, 0.010};
  SimulatedBoard board;
  ChamberProtocol chamber;
  Transducer transducer;
  std::vector<EnabledEffect> effects;  ///< in the library's order

  /// nullptr where it is not enabled.
  const EnabledEffect* effect(const std::string& id) const;
  /// Largest count of the converter.
  std::uint16_t fullScale() const;
};

/// Reads and checks a file strictly. Form (all but `simulation` and `effects` may be left out):
///
///     simulation: demo
///     seed: 1
///     matrix: {rows: 7, columns: 10, pitch_x: 0.010, pitch_y: 0.010}   # [m]
///     board: {serial: SIM-0001, scan_rate: 10, ...}                    # fields of SimulatedBoard
///     chamber: {peak: 620000, rate: 17000, cycles: 10, ...}            # see readChamberProtocol()
///     transducer: {low: -103000, high: 1034000, full_counts: 4096}
///     effects:
///       static_curve: {exponent: 0.9}   # effects that are named are enabled; {} = usual values
///
/// Throws InputError that names unknown effects and keys, and values out of range.
SimulationSettings readSimulation(const Settings& settings);
SimulationSettings readSimulationFile(const std::string& path);

}  // namespace fsr
