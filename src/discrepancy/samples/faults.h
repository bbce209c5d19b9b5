#pragma once

#include <string>
#include <utility>
#include <vector>

#include "discrepancy/samples/measured.h"
#include "fsr_pressure_map/simulation/simulation_settings.h"

namespace fsr::discrepancy {

/// Taxels or a line that fail, found by a detector.
struct Fault {
  simulation::Detector detector = simulation::Detector::kNone;
  std::string id;                                ///< id of the effect that this detector finds
  std::size_t line = 0;                          ///< index of the row or column, if a line fails
  std::vector<std::size_t> taxels;               ///< row-major
  double share = 0;                              ///< share of the scans that are faulty
  double depth = 0;                              ///< mean relative loss of the reading
  double longest = 0;                            ///< longest spell [s]
  std::vector<std::pair<double, double>> times;  ///< start and end of each spell, since the first scan [s]

  bool isLine() const {
    return detector == simulation::Detector::kRowFaults || detector == simulation::Detector::kColumnFaults;
  }
};

/// Errors that all faults cause in the readings, relative to the values expected from the other taxels.
struct FaultyReadings {
  double square = 0;    ///< squared errors, summed over scans and taxels [share of full scale, squared]
  double held_out = 0;  ///< the same over the hold-out cycles
  double readings = 0;  ///< scans x taxels
  double held_out_readings = 0;
  Interval pressure;                    ///< range in which the errors show [Pa]
  std::vector<std::string> conditions;  ///< surfaces on which they show; empty = all
};

struct Faults {
  std::vector<Fault> faults;  ///< at most one of each id
  FaultyReadings readings;
};

/// Searches every scan for faults. A taxel is stuck where it keeps one code while the others move. A taxel is
/// dead where it reads far less than the others. A line fails where its taxels suddenly deviate together from
/// the others.
Faults findFaults(const Measured& measured);

/// The effect and the parameter values with which a simulation shows the fault.
simulation::EnabledEffect asEffect(const Fault& fault);

}  // namespace fsr::discrepancy
