#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "fsr_pressure_map/view/image.h"
#include "session/conductor.h"

namespace fsr::session {

/// How many of a thing the plan has, and how many of them were accepted.
struct Share {
  unsigned planned = 0;
  unsigned accepted = 0;
};

/// Passes through the bins of pressure while loading and unloading.
struct SurfaceCoverage {
  std::string surface;
  double curvature = 0;        ///< the largest principal one, signed [1/m]
  std::vector<Share> loading;  ///< of each bin of pressure
  std::vector<Share> unloading;
};

/// What a session has recorded so far of what its plan asks for.
struct Coverage {
  static constexpr std::size_t kBins = 10;  ///< of pressure, from 0 to the largest peak
  double largest_peak = 0;                  ///< [Pa]
  std::vector<SurfaceCoverage> surfaces;    ///< by ascending curvature
  std::map<double, Share> paces;            ///< steps by pace [Pa/s]
  std::map<double, Share> dwells;           ///< steps by dwell at the peak [s]
};

/// Only recorded steps count.
Coverage coverageOf(const SessionPlan& plan, const std::vector<SessionStep>& steps,
                    const std::vector<StepState>& states);

/// A row for each surface: a cell for each bin while loading, then while unloading; below, bars for paces and
/// dwells. Each is filled by the share that was accepted, and bright where it is complete. What is not
/// planned has no cell. The size depends only on the plan. `lines`: text above.
view::Image drawCoverage(const Coverage& coverage, const std::vector<std::string>& lines);

/// The picture of drawCoverage() as SVG inside an HTML page. Each cell and bar has its numbers as a title.
std::string coverageSvg(const Coverage& coverage);

}  // namespace fsr::session
