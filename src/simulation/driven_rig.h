#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>

#include "fsr_pressure_map/dataset/recording.h"
#include "simulation/reference_channel.h"
#include "simulation/rig_state.h"
#include "simulation/sensor_chain.h"

namespace fsr::simulation {

/// The settings with the matrix and the converter's full scale of a recording, for a model of the sensor
/// that made it.
SimulationSettings fitted(const SimulationSettings& settings, const dataset::Recording& recording);

/// A simulated matrix that goes through what a real one went through: recorded pressure, surfaces and
/// temperature. The reference is what was recorded; where the settings hold an error of the reference, the
/// matrix feels the true pressure behind it.
class DrivenRig {
 public:
  /// Throws InputError.
  explicit DrivenRig(const SimulationSettings& settings);

  /// Goes through all scans of a recording; `listener` may ask the chain for its counts, readings and
  /// signals after each. Recordings must come in time order; the sheet remembers what it went through, the
  /// pressure being straight in between, and is mounted anew where surface or mount change. Throws
  /// InputError where the recording has no chamber pressure, another matrix, or begins before the last one
  /// ended.
  void run(const dataset::Recording& recording,
           const std::function<void(std::size_t scan, const SensorChain& chain)>& listener);

  /// Goes on from where another run was left; in its rig time the recordings must come after it. Throws
  /// InputError where the state belongs to another rig.
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
