#pragma once

#include <cstdint>
#include <vector>

#include "fsr_pressure_map/simulation/chamber.h"
#include "simulation/chamber_gas.h"
#include "simulation/effect.h"
#include "simulation/reference_channel.h"
#include "simulation/rig_state.h"
#include "simulation/sensor_chain.h"

namespace fsr::simulation {

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

}  // namespace fsr::simulation
