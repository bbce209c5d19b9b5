#pragma once

#include <string>
#include <vector>

#include "discrepancy/samples/measured.h"
#include "health/faults.h"

namespace fsr::discrepancy {

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
  std::vector<health::Fault> faults;  ///< at most one of each kind
  FaultyReadings readings;
};

/// Least size at the map that matters [Pa]: `least_gap`, or its share of the range of the chamber's pressure.
/// Of what changes within a cycle (not `slow`) it is at least the error of the interpolated reference.
double leastGap(const Measured& measured, const DiscrepancyOptions& options, bool slow = true);

/// health::findFaults() in the used taxels. Both tests need `level`, and a size at the map of at least
/// leastGap().
Faults findFaults(const Measured& measured, const DiscrepancyOptions& options,
                  const health::FaultProgress& progress = {});

/// The effect that shows such a fault.
const simulation::EffectInfo& effectOf(const health::Fault& fault);

}  // namespace fsr::discrepancy
