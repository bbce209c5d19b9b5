#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fsr_pressure_map/dataset/recording.h"
#include "fsr_pressure_map/simulation/chamber.h"
#include "fsr_pressure_map/simulation/simulation_settings.h"
#include "rheology/memory.h"
#include "settings/settings.h"
#include "simulation/effects/effect_library.h"
#include "simulation/sensor_chain.h"

namespace fsr::simulation {

/// The gas in the chamber. Its temperature depends on the history of the pressure.
class ChamberGas {
 public:
  explicit ChamberGas(const ChamberClimate& climate);

  /// Temperature at `time` [s], when the chamber is at the gauge pressure `pressure` [Pa]. The pressure is
  /// taken to be linear since the previous call. Times must ascend.
  double temperature(double time, double pressure);  // [degree Celsius]

  /// Its state, for saving and restoring.
  std::vector<double>& state() { return state_; }
  const std::vector<double>& state() const { return state_; }

 private:
  double room(double time) const;

  ChamberClimate climate_;
  rheology::ExponentialMemory cooling_;
  std::vector<double> state_;
};

/// The chamber's pressure transducer. Input: the gauge pressure of the chamber. Output: the pressure that a
/// recording contains, after the effects of the stage kReference and the transducer's converter.
class ReferenceChannel {
 public:
  /// Throws InputError.
  explicit ReferenceChannel(const SimulationSettings& settings);

  /// What the transducer shows before its converter [Pa].
  double indicated(double pressure) const;
  /// Inverse of indicated(): the chamber's pressure when the transducer shows `indicated` [Pa].
  double truePressure(double indicated) const;

  /// What its converter makes of the chamber's pressure [Pa].
  std::int32_t counts(double pressure) const { return transducer_.counts(indicated(pressure)); }

 private:
  Transducer transducer_;
  std::vector<std::unique_ptr<Effect>> effects_;
};

/// The state of a simulated rig between two runs.
struct RigState {
  std::int64_t origin_ns = 0;  ///< date of rig time 0 [ns since 1970]
  double time = 0;             ///< rig time at which it was left [s]
  std::uint64_t scans = 0;     ///< number of scans so far; selects the noise
  std::uint32_t mount = 0;     ///< number of the last mount
  std::string surface;         ///< of that mount
  std::vector<double> gas;     ///< ChamberGas::state(); empty = at rest
  ChainState sheet;
};

/// The state as a YAML file; readRigState() reads back the same, bit for bit.
std::string stateText(const RigState& state);
/// Throws InputError. Whether the state fits a rig is checked when it is restored.
RigState readRigState(const settings::Settings& settings);

/// Matrix, transducer and thermometer in one chamber. Times are rig time [s] and must ascend for each of the
/// three. The pressure is evaluated at the time itself and during the scan round it.
class Rig {
 public:
  /// Throws InputError.
  explicit Rig(const SimulationSettings& settings);

  /// Lays the matrix on a surface. Throws InputError.
  void mount(const matrix::Surface& surface, const LoadPattern& pattern = {}) {
    chain_.mount(surface, pattern);
  }

  /// Counts of a scan whose middle is at `time`, [rows x columns], row-major; valid until the next call.
  const std::vector<std::uint16_t>& scan(double time, const PressureCourse& pressure);
  /// Counts of the transducer's converter.
  std::int32_t transducer(double time, const PressureCourse& pressure) const;
  /// Reading of the thermometer [degree Celsius].
  double temperature(double time, const PressureCourse& pressure);

  std::uint64_t scans() const { return scans_; }
  /// Save and restore the state of sheet and gas, and the number of scans.
  void save(RigState& state) const;
  /// Throws InputError where the state belongs to another rig.
  void restore(const RigState& state);
  SensorChain& chain() { return chain_; }
  const SensorChain& chain() const { return chain_; }

 private:
  SensorChain chain_;
  ReferenceChannel reference_;
  ChamberGas gas_;
  std::uint64_t scans_ = 0;
};

/// The settings with the matrix and the converter's full scale of a recording, for a model of the sensor
/// that made it.
SimulationSettings fitted(const SimulationSettings& settings, const dataset::Recording& recording);

/// A simulated matrix under the recorded pressure, surfaces and temperature of a real one. The recorded
/// pressure is the reference. Where the settings contain an error of the reference, the matrix gets the true
/// pressure.
class DrivenRig {
 public:
  /// Throws InputError.
  explicit DrivenRig(const SimulationSettings& settings);

  /// Simulates all scans of a recording. `listener` is called after each scan and may read counts, readings
  /// and signals of the chain. Recordings must come in time order. The sheet keeps its state between them,
  /// and the pressure is linear in between. The sheet is mounted again where surface or mount change. Throws
  /// InputError where the recording has no chamber pressure, is of another matrix, or begins before the last
  /// one ended.
  void run(const dataset::Recording& recording,
           const std::function<void(std::size_t scan, const SensorChain& chain)>& listener);

  /// Continues after another run. In its rig time the recordings must come after it. Throws InputError where
  /// the state belongs to another rig.
  void resume(const RigState& state);
  RigState state() const;

  const SensorChain& chain() const { return chain_; }

 private:
  void require(const dataset::Recording& recording) const;
  void lie(const matrix::Surface& surface);

  SimulationSettings settings_;
  SensorChain chain_;
  ReferenceChannel reference_;
  std::optional<std::int64_t> origin_ns_;   // stamp of rig time 0
  double end_ = 0;                          // of the last recording [s]
  std::optional<matrix::Surface> surface_;  // on which it lies
  std::optional<RigState> resumed_;         // until the sheet is mounted
  std::uint64_t scans_ = 0;
};

}  // namespace fsr::simulation
