#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "settings/settings.h"
#include "simulation/chamber_gas.h"
#include "simulation/sensor_chain.h"

namespace fsr::simulation {

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

}  // namespace fsr::simulation
