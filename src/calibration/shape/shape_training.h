#pragma once

#include <string>
#include <vector>

#include "calibration/session/session_rests.h"
#include "calibration/shape/shape_check.h"
#include "fsr_pressure_map/calibration/calibration.h"
#include "fsr_pressure_map/compensation/shape.h"

namespace fsr::calibration {

/// The mean reading of each taxel over the scans. Taxels that are masked have none.
compensation::RestReading readingAtRest(const dataset::Recording& recording,
                                        const std::vector<std::size_t>& scans);

/// One mount of the sheet, with the readings at the first rest of the bags on it.
struct MountedRest {
  std::string name;  ///< e.g. "a.bag, flat, mount 2"
  matrix::Surface surface;
  std::size_t curvature_class = 0;
  compensation::RestReading rest;
  /// Of its first bag: before the load and at the last rest after it; empty = there is no such rest.
  std::vector<compensation::RestReading> after;
};

/// The mounts that start with a rest at ambient pressure. Sessions with the same class and mount number are
/// one mount.
std::vector<MountedRest> mountedRests(const std::vector<dataset::Recording>& recordings,
                                      const Sessions& sessions);

/// Learns how the sheet reads at rest on each surface, see compensation::ShapeModel. `calibration` must have
/// its tables. Where nothing can be learnt, the model says why.
compensation::ShapeModel learnShape(const std::vector<MountedRest>& mounts, const Calibration& calibration);

/// A mount whose readings at rest are not those of the surface that it is said to lie on.
struct MisplacedMount {
  std::size_t mount = 0;  ///< index into the mounts
  compensation::ShapeEstimate estimate;
};

/// Compares each mount with a model that is learnt from the others. At most one mount in a hundred sets of
/// correct bags is named. Where several mounts disagree, the one that disagrees most is left out before the
/// others are compared again.
std::vector<MisplacedMount> findMisplacedMounts(std::vector<MountedRest> mounts,
                                                const Calibration& calibration);

/// A mount, compared with a calibration that was not trained on it.
struct CheckedMount {
  MountedRest mount;
  ShapeCheck check;
};

/// Compares the surface of each mount that starts with a rest. Throws InputError if a recording does not fit
/// the calibration.
std::vector<CheckedMount> checkShapes(const Calibration& calibration,
                                      const std::vector<dataset::Recording>& recordings);

/// Gives the calibration its model of the shape, and a warning for each misplaced mount.
void trainShape(const std::vector<dataset::Recording>& recordings, const Sessions& sessions,
                Calibration& calibration);

}  // namespace fsr::calibration
