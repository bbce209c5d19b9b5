#pragma once

#include <vector>

namespace fsr::simulation {

/// Temperature of the room at one time.
struct TemperaturePoint {
  double time = 0;         ///< rig time [s]
  double temperature = 0;  ///< [degree Celsius]
};

/// Temperature of the room and of the gas round the matrix.
struct ChamberClimate {
  /// Of the room, by ascending time: linear between the points, constant outside them. Empty = 23 degree
  /// Celsius.
  std::vector<TemperaturePoint> room;
  /// Compressed gas gets warmer and cools down at the walls: increase of the temperature with the pressure
  /// [K/Pa], and time constant of the cooling [s]. Off by default; nobody has published either number for
  /// such a chamber.
  double heating = 0;
  double cooling = 20;
};

}  // namespace fsr::simulation
