#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "fsr_pressure_map/dataset/recording.h"

namespace fsr::dataset {

struct ReferenceLagOptions {
  double longest = 5.0;            ///< largest lag to search for, in both directions [s]
  double least_correlation = 0.5;  ///< with less the matrix does not follow the chamber, or nothing changed
};

/// Time lag between the matrix and the chamber pressure.
struct ReferenceLag {
  double seconds = 0;  ///< positive: the matrix follows chamber_pressure later [s]
  double correlation = 0;
  double step = 0;  ///< of the grid on which it was found [s]
};

/// The lag at which the rate of change of the sheet's median reading correlates best with that of a reading
/// that follows the chamber pressure at once, through a curve that gives both the same quantiles. None where
/// there is no reference, fewer than 50 scans, or no lag with enough correlation. A lag shows stamps of two
/// different clocks. Hysteresis also causes a lag of up to some tenths of a second, because the sheet turns
/// later than its load. Rates are compared instead of values, because hysteresis does not move the corners of
/// a curve. Gaps are bridged by straight lines.
std::optional<ReferenceLag> referenceLag(const Recording& recording, const ReferenceLagOptions& options = {});
/// The same of a sheet whose reading is known at each time [s].
std::optional<ReferenceLag> referenceLag(const std::vector<double>& time, const std::vector<double>& reading,
                                         const std::vector<double>& pressure,
                                         const ReferenceLagOptions& options = {});

/// Limits of a spell during which the reference was wrong.
struct ReferenceSpikeOptions {
  double least = 0.1;  ///< height of a spike: share of the usual range of the pressure (ratio)
  double follows =
      0.25;  ///< the sheet follows if its reading moves this share of what the pressure does (ratio)
  double longest = 10;  ///< of a spell [s]
  double most =
      0.006;  ///< share of readings; with more, the reference has no spikes but is not of this sheet
};

/// Chamber pressures that the sheet did not feel: the pressure jumps away and back to where it was within a
/// few seconds, and at neither jump the sheet's reading follows. Where it does not come back, a late clock
/// may be the cause, and nothing is said. A pulse that the sheet feels is none. `time` [s] ascends;
/// `pressure` is finite; `reading` is the sheet's mean reading at each time, NaN = none near. Returns the
/// indices, ascending.
std::vector<std::size_t> referenceSpikes(const std::vector<double>& time, const std::vector<double>& pressure,
                                         const std::vector<double>& reading,
                                         const ReferenceSpikeOptions& options = {});

}  // namespace fsr::dataset
