#pragma once

#include <cstddef>
#include <vector>

namespace fsr::dataset {

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
