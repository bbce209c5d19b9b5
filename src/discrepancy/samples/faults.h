#pragma once

#include <string>
#include <utility>
#include <vector>

#include "discrepancy/samples/measured.h"
#include "fsr_pressure_map/simulation/simulation_settings.h"

namespace fsr::discrepancy {

/// A taxel or a line that fails, found by a test of its own.
struct Fault {
  simulation::Detector detector = simulation::Detector::kNone;
  std::string id;                                ///< of the effect that this detector finds
  std::size_t line = 0;                          ///< row or column, of a line
  std::vector<std::size_t> taxels;               ///< row-major
  double share = 0;                              ///< of the scans
  double depth = 0;                              ///< mean loss of the reading, relative
  double longest = 0;                            ///< spell [s]
  std::vector<std::pair<double, double>> times;  ///< spells [s] since the first scan

  bool isLine() const {
    return detector == simulation::Detector::kRowFaults || detector == simulation::Detector::kColumnFaults;
  }
};

/// What all faults do to the readings, against what the other taxels say.
struct FaultyReadings {
  double square = 0;    ///< summed over scans and taxels [share of full scale, squared]
  double held_out = 0;  ///< the same over the hold-out cycles
  double readings = 0;  ///< scans x taxels
  double held_out_readings = 0;
  Interval pressure;                    ///< where they differ [Pa]
  std::vector<std::string> conditions;  ///< surfaces; empty = all
};

struct Faults {
  std::vector<Fault> faults;  ///< at most one of each id
  FaultyReadings readings;
};

/// Looks through every scan. A taxel is stuck where it keeps one code while the others move, dead where
/// it falls far below what they say; a line fails where its taxels leave the others together, suddenly.
Faults findFaults(const Measured& measured);

/// How the simulation would be told of a fault.
simulation::EnabledEffect asEffect(const Fault& fault);

}  // namespace fsr::discrepancy
