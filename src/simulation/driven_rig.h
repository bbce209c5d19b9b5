#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>

#include "fsr_pressure_map/dataset/recording.h"
#include "simulation/rig.h"
#include "simulation/sensor_chain.h"

namespace fsr::simulation {

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
