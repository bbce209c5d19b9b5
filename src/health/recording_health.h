#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "fsr_pressure_map/dataset/recording.h"
#include "fsr_pressure_map/health/taxel_watch.h"

namespace fsr::health {

/// State of a matrix, from the readings of a recording alone.
struct RecordingHealth {
  std::vector<std::size_t> dead, stuck;    ///< taxels that TaxelWatch found at any time, row-major
  std::vector<std::size_t> rows, columns;  ///< line faults
  double saturated = 0;                    ///< share of readings at full scale, without masked taxels (ratio)
  std::size_t saturated_taxels = 0;        ///< taxels at full scale in more than 1 % of the scans
  /// Lowest chamber pressure at which a taxel was at full scale [Pa]; NaN = none was, or no reference.
  double saturated_from = std::numeric_limits<double>::quiet_NaN();
};

/// Runs TaxelWatch over the recording and counts readings at full scale. Masked taxels are ignored.
RecordingHealth recordingHealth(const dataset::Recording& recording, const TaxelWatchOptions& options = {});

}  // namespace fsr::health
