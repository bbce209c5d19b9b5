#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "settings/settings.h"
#include "simulation/chamber_gas.h"
#include "simulation/sensor_chain.h"

namespace fsr::simulation {

/// All that a simulated rig remembers from one run to the next.
struct RigState {
  std::int64_t origin_ns = 0;  ///< date of rig time 0 [ns since 1970]
  double time = 0;             ///< rig time at which it was left [s]
  std::uint64_t scans = 0;     ///< taken so far: numbers the noise
  std::uint32_t mount = 0;     ///< number of the last mount
  std::string surface;         ///< on which the sheet then lay
  std::vector<double> gas;     ///< ChamberGas::state(); empty = at rest
  ChainState sheet;
};

/// The state as a YAML file; readRigState() reads back the same, bit for bit.
std::string stateText(const RigState& state);
/// Throws InputError; whether the state fits a rig is seen when it is restored.
RigState readRigState(const settings::Settings& settings);

}  // namespace fsr::simulation
