#pragma once

#include <vector>

#include "fsr_pressure_map/rheology/exponential_memory.h"
#include "fsr_pressure_map/settings/settings.h"

namespace fsr::simulation {

/// A moment of the room's temperature.
struct TemperaturePoint {
  double time = 0;         ///< rig time [s]
  double temperature = 0;  ///< [degree Celsius]
};

/// Temperature round the matrix.
struct ChamberClimate {
  /// Of the room, by ascending time, straight between the points and held outside; empty = 23 all the time.
  std::vector<TemperaturePoint> room;
  /// Gas that is compressed gets warmer and cools down at the walls: rise by pressure [K/Pa], and time
  /// constant of the cooling [s]. Off by default; nobody has published either for such a chamber.
  double heating = 0;
  double cooling = 20;
};

/// Reads the mapping `room: [{time: 0, temperature: 23}, ...]` (or one number), `heating`, `cooling`.
/// Throws InputError.
ChamberClimate readChamberClimate(const settings::Settings& settings);

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
