#pragma once

#include <vector>

#include "fsr_pressure_map/simulation/chamber_climate.h"
#include "rheology/exponential_memory.h"

namespace fsr::simulation {

/// The gas in the chamber, whose temperature follows the pressure's history.
class ChamberGas {
 public:
  explicit ChamberGas(const ChamberClimate& climate);

  /// Temperature at a time at which the chamber stands at that gauge pressure; the pressure ran straight
  /// since the call before. Times must ascend.
  double temperature(double time, double pressure);  // [degree Celsius]

  /// What it remembers, for saving and restoring.
  std::vector<double>& state() { return state_; }
  const std::vector<double>& state() const { return state_; }

 private:
  double room(double time) const;

  ChamberClimate climate_;
  rheology::ExponentialMemory cooling_;
  std::vector<double> state_;
};

}  // namespace fsr::simulation
