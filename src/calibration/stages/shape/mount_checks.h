#pragma once

#include <cstddef>
#include <vector>

#include "calibration/stages/shape/mounted_rests.h"
#include "calibration/stages/shape/shape_check.h"
#include "fsr_pressure_map/calibration/calibration.h"

namespace fsr::calibration {

/// A mount whose readings at rest are not those of the surface that it is said to lie on.
struct MisplacedMount {
  std::size_t mount = 0;  ///< index into the mounts
  ShapeEstimate estimate;
};

/// Compares each mount with a model that is learnt from the others. At most one mount in a hundred sets of
/// correct bags is named. Where several mounts disagree, the one that disagrees most is left out before the
/// others are compared again. `threads`: 0 = one for each core; the result does not depend on it.
std::vector<MisplacedMount> findMisplacedMounts(std::vector<MountedRest> mounts,
                                                const Calibration& calibration, unsigned threads);

/// A mount, compared with a calibration that was not trained on it.
struct CheckedMount {
  MountedRest mount;
  ShapeCheck check;
};

/// Compares the surface of each mount that starts with a rest. Throws InputError if a recording does not fit
/// the calibration.
std::vector<CheckedMount> checkShapes(const Calibration& calibration,
                                      const std::vector<dataset::Recording>& recordings);

}  // namespace fsr::calibration
