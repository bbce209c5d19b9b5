#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "fsr_pressure_map/ros/bag_reader.h"
#include "fsr_pressure_map/simulation/simulation_settings.h"
#include "simulation/rig.h"

namespace fsr_ros {

/// Output of a simulation.
struct SimulatedBags {
  std::string output;                                     ///< folder for the bags
  std::optional<fsr::simulation::RigState> state;         ///< state to continue from; none = a new sheet
  std::function<void(const std::string& path)> progress;  ///< called before each bag is written
  /// Called now and then with what is done and its share; none = nobody asks.
  std::function<void(const std::string& step, double share)> told = {};
};

/// Result of a simulation.
struct SimulatedRun {
  fsr::simulation::SimulationSettings
      rig;                          ///< settings as used: with the matrix and full scale of the driving bags
  fsr::simulation::RigState state;  ///< state of the rig at the end
  std::vector<std::string> warnings;  ///< sentences for the user about the driving bags
};

/// Runs the session of the simulation and writes one bag for each station ("1_flat.bag",
/// "2_cylinder_5cm.bag"). The bags have the topics of record.launch, and the driver's own functions make the
/// messages. Throws fsr::InputError.
SimulatedRun writeSessionBags(const fsr::simulation::SimulationSettings& settings, const SimulatedBags& bags);

/// Recorded bags that drive a simulated sensor.
struct DrivingBags {
  std::vector<std::string> paths;  ///< in time order
  BagReadOptions how = {};
};

/// Reads all scans of a bag that have a reference, including those near a change of surface. Throws
/// fsr::settings::InputError.
fsr::dataset::Recording readWhole(const std::string& path, BagReadOptions how);

/// Runs the simulated sensor on the recorded pressure, surfaces and temperature of real bags, and writes
/// copies of the bags under the same names. In the copies, `raw` holds the simulated readings at the stamps
/// of the recorded scans, and `matrix_info` describes the simulated sensor. Scans without a chamber pressure
/// before and after them are left out. The matrix size and the full scale are those of the bags. Throws
/// fsr::InputError.
SimulatedRun writeDrivenBags(const fsr::simulation::SimulationSettings& settings, const DrivingBags& driving,
                             const SimulatedBags& bags);

}  // namespace fsr_ros
