#pragma once

#include <vector>

namespace fsr::simulation {

/// A sample of the room's temperature.
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

}  // namespace fsr::simulation
