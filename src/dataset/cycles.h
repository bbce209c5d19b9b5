#pragma once

#include <cstddef>
#include <vector>

#include "fsr_pressure_map/statistics/metrics.h"

namespace fsr::dataset {

/// How far the pressure must return before a peak or a valley counts.
struct CycleOptions {
  double share_of_range = 0.05;  ///< share of (largest - smallest pressure of the series)
  double least = 2e3;            ///< and at least this, so that noise makes no cycle [Pa]
};

/// Fill and vent cycles of a chamber. A cycle runs from one valley to the next.
struct Cycles {
  std::vector<std::size_t> first;  ///< index of each cycle's first reading; first[0] = 0
  std::vector<statistics::LoadDirection>
      direction;  ///< of each reading; kNone where the pressure never changes

  std::size_t count() const { return first.size(); }
};

/// Finds the cycles of `pressure` [Pa], which must be finite and in the order of time. A series that is empty
/// or never changes has no cycle. A single rise or fall is one cycle.
Cycles findCycles(const std::vector<double>& pressure, const CycleOptions& options = {});

}  // namespace fsr::dataset
