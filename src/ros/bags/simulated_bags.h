#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "fsr_pressure_map/simulation/simulation_settings.h"
#include "simulation/rig_state.h"

namespace fsr_ros {

/// What simulated bags are written with.
struct SimulatedBags {
  std::string output;                                     ///< folder
  std::optional<fsr::simulation::RigState> state;         ///< where the rig goes on from; empty = a new sheet
  std::function<void(const std::string& path)> progress;  ///< told each bag that is about to be written
};

/// What came of it.
struct SimulatedRun {
  fsr::simulation::SimulationSettings
      rig;                            ///< as it ran: with the matrix and full scale of bags that drove it
  fsr::simulation::RigState state;    ///< what it remembers at the end
  std::vector<std::string> warnings;  ///< sentences for the user about bags that drove it
};

/// Goes through the simulation's session and writes a bag for each station, "1_flat.bag",
/// "2_cylinder_5cm.bag": the topics and messages of record.launch, made by the driver's own functions.
/// Throws fsr::InputError.
SimulatedRun writeSessionBags(const fsr::simulation::SimulationSettings& settings, const SimulatedBags& bags);

/// What drives a simulated sensor.
struct DrivingBags {
  std::vector<std::string> paths;  ///< in time order
  std::string topics;              ///< namespace of the sensor; empty = the only one
};

/// Runs the simulated sensor on the recorded pressure, surfaces and temperature of real bags and writes
/// copies of the same names in which `raw` holds what it reads, at the stamps of the recorded scans, and
/// `matrix_info` says that it is the simulated sensor. Scans that no chamber pressure brackets are left
/// out. The matrix and the full scale are those of the bags. Throws fsr::InputError.
SimulatedRun writeDrivenBags(const fsr::simulation::SimulationSettings& settings, const DrivingBags& driving,
                             const SimulatedBags& bags);

}  // namespace fsr_ros
