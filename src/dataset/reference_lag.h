#pragma once

#include <optional>

#include "fsr_pressure_map/dataset/recording.h"

namespace fsr::dataset {

struct ReferenceLagOptions {
  double longest = 5.0;            ///< lag that is looked for, either way [s]
  double least_correlation = 0.5;  ///< below it the matrix does not follow the chamber, or nothing moved
};

/// How the matrix follows the chamber in time.
struct ReferenceLag {
  double seconds = 0;  ///< positive: the matrix answers later than its chamber_pressure says [s]
  double correlation = 0;
};

/// Where the rate of change of the sheet's median reading fits that of the chamber pressure best. None where
/// there is no reference, fewer than 50 scans, or no lag fits. Stamps of two clocks show here; so does, up to
/// some tenths of a second, the hysteresis of a sheet that turns later than its load: rates are compared and
/// not values, because a loop leaves corners where they are. Gaps are bridged by straight lines.
std::optional<ReferenceLag> referenceLag(const Recording& recording, const ReferenceLagOptions& options = {});

}  // namespace fsr::dataset
