#include "calibration/shape/shape_training.h"

#include "calibration/shape/learn_from_mounts.h"
#include "calibration/shape/mount_checks.h"

namespace fsr::calibration {

void trainShape(const std::vector<dataset::Recording>& recordings, const Sessions& sessions, unsigned threads,
                Calibration& calibration) {
  const std::vector<MountedRest> mounts = mountedRests(recordings, sessions);
  calibration.shape = learnShape(mounts, calibration);
  for (const MisplacedMount& misplaced : findMisplacedMounts(mounts, calibration, threads)) {
    const MountedRest& mount = mounts[misplaced.mount];
    const double declared = matrix::principalCurvature(mount.surface.curvature.front());
    calibration.warnings.push_back(
        mount.name + ": " + restText(misplaced.estimate) + ", but its surface is " + bendText(declared) +
        ": a surface that is declared wrongly spoils the calibration; correct it, or leave "
        "the bag out");
  }
}

}  // namespace fsr::calibration
