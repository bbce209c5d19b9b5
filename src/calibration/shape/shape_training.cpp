#include "calibration/shape/shape_training.h"

#include <algorithm>

#include "calibration/shape/learn_from_mounts.h"
#include "calibration/shape/mount_checks.h"

namespace fsr::calibration {

namespace {

// Why mounts of the bags do not count: "; without a rest before the first load: b.bag, flat, mount 2".
std::string withoutRest(const std::vector<dataset::Recording>& recordings, const Sessions& sessions) {
  constexpr std::size_t kNamed = 4;
  const std::vector<std::string> names = mountsWithoutRest(recordings, sessions);
  std::string text;
  for (std::size_t i = 0; i < std::min(kNamed, names.size()); ++i)
    text += (i == 0 ? "; without a rest before the first load: " : "; ") + names[i];
  return names.size() > kNamed ? text + "; and " + std::to_string(names.size() - kNamed) + " more" : text;
}

}  // namespace

void trainShape(const std::vector<dataset::Recording>& recordings, const Sessions& sessions, unsigned threads,
                Calibration& calibration) {
  const std::vector<MountedRest> mounts = mountedRests(recordings, sessions);
  calibration.shape = learnShape(mounts, calibration);
  if (!calibration.shape.missing.empty()) calibration.shape.missing += withoutRest(recordings, sessions);
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
