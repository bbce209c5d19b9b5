#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "fsr_pressure_map/discrepancy/discrepancy.h"

namespace fsr::discrepancy {

/// A gap, and the gap on each surface in order of time [share of full scale].
struct RecomputedGap {
  double rms = 0;  ///< NaN if there is no scan
  std::vector<std::pair<std::string, double>> surfaces;
};

/// Recomputes the gap of one simulation from the hold-out spans of a verdict. `progress` is called with the
/// share of the scans that are simulated.
RecomputedGap recomputeGap(const std::vector<dataset::Recording>& recordings,
                           const std::vector<HoldOutCycles>& hold_out,
                           const simulation::SimulationSettings& simulation,
                           const std::function<void(double share)>& progress = {});

}  // namespace fsr::discrepancy
