#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "fsr_pressure_map/dataset/recording.h"
#include "fsr_pressure_map/health/taxel_watch.h"

namespace fsr::health {

/// What the readings of a recording alone tell of its matrix.
struct RecordingHealth {
  std::vector<std::size_t> dead, stuck;    ///< taxels that TaxelWatch found at any time, row-major
  std::vector<std::size_t> rows, columns;  ///< line faults
  double saturated = 0;                    ///< readings at full scale, of all that are not masked (ratio)
  std::size_t saturated_taxels = 0;        ///< that were at full scale in more than 1 % of the scans
  /// Lowest chamber pressure at which a taxel was at full scale [Pa]; NaN = none was, or no reference.
  double saturated_from = std::numeric_limits<double>::quiet_NaN();
};

/// Runs the live watch over the recording and counts clipping. Masked taxels take no part.
RecordingHealth recordingHealth(const dataset::Recording& recording, const TaxelWatchOptions& options = {});

}  // namespace fsr::health
