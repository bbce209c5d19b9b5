#pragma once

#include <vector>

#include "fsr_pressure_map/simulation/chamber.h"
#include "rheology/exponential_memory.h"

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

}  // namespace fsr::simulation
