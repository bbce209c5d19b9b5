#include "calibration/stages/shape/mount_checks.h"

#include <algorithm>
#include <numeric>
#include <optional>

#include "calibration/sources.h"
#include "calibration/stages/shape/learn_from_mounts.h"
#include "calibration/stages/shape/read_shape.h"
#include "matrix/for_each_taxel.h"

namespace fsr::calibration {

namespace {

constexpr double kFalseAlarms = 0.01;  // of a whole set of mounts

std::vector<MountedRest> without(std::vector<MountedRest> mounts, std::size_t mount) {
  mounts.erase(mounts.begin() + static_cast<std::ptrdiff_t>(mount));
  return mounts;
}

// How strongly a mount disagrees with what the others teach: the difference of the logarithms of the
// likelihood of its best curvature and of the declared one. Nothing where it agrees, or where no other mount
// is on its surface. The scatter is learnt without the mount, too: one wrong surface would widen it so much
// that everything agrees, or draw the mean so far that the sound mounts are blamed.
std::optional<double> disagreement(const std::vector<MountedRest>& mounts, std::size_t mount, double alarm,
                                   const Calibration& calibration) {
  const MountedRest& own = mounts[mount];
  const auto beside = [&](const MountedRest& other) { return other.curvature_class == own.curvature_class; };
  if (!bentAlike(own.surface) || std::count_if(mounts.begin(), mounts.end(), beside) < 2) return {};
  const ShapeModel model = learnShape(without(mounts, mount), calibration, false);
  if (agreesIfConstant(model, own.rest, own.surface, alarm)) return {};
  const ShapeCheck check = checkShape(model, own.rest, own.surface, alarm);
  if (check.verdict != ShapeVerdict::kDisagrees) return {};
  const double declared = matrix::principalCurvature(own.surface.curvature.front());
  return check.estimate.likelihood - ShapeReader(model).likelihood(own.rest, {declared}).logarithm;
}

}  // namespace

std::vector<MisplacedMount> findMisplacedMounts(std::vector<MountedRest> mounts,
                                                const Calibration& calibration, unsigned threads) {
  std::vector<MisplacedMount> misplaced;
  std::vector<std::size_t> numbers(mounts.size());
  std::iota(numbers.begin(), numbers.end(), std::size_t{0});
  const double alarm = kFalseAlarms / double(std::max<std::size_t>(1, mounts.size()));
  while (true) {
    std::vector<double> each(mounts.size(), -1);  // -1 = agrees
    matrix::forEachTaxel(mounts.size(), threads, [&](std::size_t mount) {
      each[mount] = disagreement(mounts, mount, alarm, calibration).value_or(-1);
    });
    const auto most = std::max_element(each.begin(), each.end());  // the first of equal ones
    if (most == each.end() || *most < 0) return misplaced;
    const auto worst = static_cast<std::size_t>(most - each.begin());
    const MountedRest wrong = mounts[worst];
    mounts = without(std::move(mounts), worst);
    const ShapeCheck check = checkShape(learnShape(mounts, calibration), wrong.rest, wrong.surface, alarm);
    misplaced.push_back({numbers[worst], check.estimate});
    numbers.erase(numbers.begin() + static_cast<std::ptrdiff_t>(worst));
  }
}

namespace {

// Why the mount cannot be compared; empty = it can.
std::string obstacleTo(const MountedRest& mount, const Calibration& calibration) {
  const std::string sensor = sensorObstacle(mount.serial, calibration.sensor.serial);
  const TrainedInterval& trained = calibration.trained.temperature;
  return sensor.empty() ? temperatureObstacle(mount.temperature, trained.low, trained.high) : sensor;
}

}  // namespace

std::vector<CheckedMount> checkShapes(const Calibration& calibration,
                                      const std::vector<dataset::Recording>& recordings) {
  for (const dataset::Recording& recording : recordings) requireFit(calibration, recording);
  const Sessions sessions = findSessions(recordings, dataset::poolConditions(recordings));
  std::vector<CheckedMount> checked;
  for (const MountedRest& mount : mountedRests(recordings, sessions)) {
    const std::string obstacle = obstacleTo(mount, calibration);
    checked.push_back({mount, obstacle.empty() ? checkShape(calibration.shape, mount.rest, mount.surface)
                                               : abstainsBecause(obstacle)});
  }
  return checked;
}

}  // namespace fsr::calibration
