#include "calibration/stages/shape/shape_check.h"

#include <boost/math/distributions/chi_squared.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "calibration/sources.h"
#include "calibration/stages/shape/learn_from_mounts.h"
#include "calibration/stages/shape/learn_shape.h"
#include "calibration/stages/shape/read_shape.h"
#include "fsr_pressure_map/dataset/condition_classes.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "matrix/for_each_taxel.h"
#include "settings/number_text.h"

namespace fsr::calibration {

namespace {

constexpr double kWidest = 0.5;  // share of the range of training: a wider interval tells too little
// A model allows for 3 % of sensitivity; sheets change by some 0.4 to 0.6 % a kelvin.
constexpr double kTemperatureMargin = 5;  // [K]
constexpr double kBadFit = 0.05;  // a fit that is worse with this probability says that something else acts

std::vector<double> principalCurvatures(const matrix::Surface& surface) {
  std::vector<double> curvatures;
  for (const matrix::Curvature& c : surface.curvature) curvatures.push_back(matrix::principalCurvature(c));
  return curvatures;
}

// "cylinder_9cm (9.0 cm)", "cone (12.5 cm to 8.3 cm)".
std::string declaredText(const matrix::Surface& surface) {
  const std::vector<double> bends = principalCurvatures(surface);
  const auto [low, high] = std::minmax_element(bends.begin(), bends.end());
  const std::string name = surface.name.empty() ? "the declared surface" : surface.name;
  return name + " (" + bendText(*low) + (*low == *high ? "" : " to " + bendText(*high)) + ")";
}

std::string abstention(const std::string& why) {
  return "how the sheet lies cannot be told: " + why;
}

std::string unfit(const ShapeModel& model) {
  return "the readings at rest fit none of the bends of training, " + bendText(model.curvature.front()) +
         " to " + bendText(model.curvature.back()) +
         "; a load or a strap, another temperature, another sheet or a bend beyond training would explain it";
}

}  // namespace

std::string bendText(double curvature) {
  if (std::abs(curvature) <= dataset::kFlatCurvature) return "flat";
  return (curvature < 0 ? "concave, " : "") + settings::fixedText(100 / std::abs(curvature), 1) + " cm";
}

std::string restText(const ShapeEstimate& estimate) {
  return "the sheet rests as on " + bendText(estimate.curvature) + " (" + bendText(estimate.high) + " to " +
         bendText(estimate.low) + ")";
}

std::string openText(const ShapeEstimate& estimate) {
  return abstention("the readings at rest leave " + bendText(estimate.high) + " to " +
                    bendText(estimate.low) + " open");
}

namespace {

double rangeOf(const ShapeModel& model) {
  return model.curvature.back() - model.curvature.front();
}

// "a bend that changes from 12.5 cm to 8.3 cm along a row": along the axis of the larger change.
std::string changeText(const ChangingBend& bend) {
  const bool row = std::abs(bend.along_x.change) >= std::abs(bend.along_y.change);
  const double half = (row ? bend.along_x : bend.along_y).change / 2;
  return "a bend that changes from " + bendText(bend.centre - half) + " to " + bendText(bend.centre + half) +
         " along a " + (row ? "row" : "column");
}

double limitOf(double alarm, int parameters) {
  return boost::math::quantile(boost::math::complement(boost::math::chi_squared(parameters), alarm));
}

/// Compares the readings of one rest with declared surfaces.
class Comparison {
 public:
  Comparison(const ShapeModel& model, const RestReading& rest, double alarm)
      : model_(model), rest_(rest), reader_(model), alarm_(alarm), estimate_(reader_.estimate(rest)) {}

  const ShapeEstimate& estimate() const { return estimate_; }

  bool agrees(const std::vector<double>& curvature) const {
    return 2 * (estimate_.likelihood - logarithm(curvature)) <= limitOf(alarm_, 1);
  }

  void check(const matrix::Surface& declared, ShapeCheck& check) const {
    check.estimate = estimate_;
    check.change = tellBendChange(reader_, model_, rest_, estimate_);
    check.changes = check.change.probability < alarm_ && check.change.fit >= kBadFit;
    if (check.changes) {
      judgeChanging(declared, check);
    } else if (estimate_.fit < kBadFit) {
      check.sentence = abstention(unfit(model_));
    } else {
      judgeConstant(declared, check);
    }
  }

 private:
  double logarithm(const std::vector<double>& curvature) const {
    return reader_.likelihood(rest_, curvature).logarithm;
  }

  // A strap over a part of the sheet reads like a bend that changes: only a surface file that says so is
  // believed. The best of three numbers is compared.
  void judgeChanging(const matrix::Surface& declared, ShapeCheck& check) const {
    const bool varies = declared.curvature.size() > 1;
    if (varies &&
        2 * (check.change.likelihood - logarithm(principalCurvatures(declared))) <= limitOf(alarm_, 3)) {
      check.verdict = ShapeVerdict::kAgrees;
      check.sentence = "the sheet rests as on " + changeText(check.change) + ", which agrees with " +
                       declaredText(declared);
    } else {
      check.sentence = abstention("the readings at rest fit no single bend; " + changeText(check.change) +
                                  " would explain them, and so would a load on a part of the sheet");
    }
  }

  void judgeConstant(const matrix::Surface& declared, ShapeCheck& check) const {
    for (std::size_t s = 0; s < model_.curvature.size(); ++s) {
      if (agrees({model_.curvature[s]})) check.possible.push_back(model_.surfaces[s]);
    }
    const std::string found = restText(estimate_);
    check.estimated = !estimate_.beyond && estimate_.high - estimate_.low <= kWidest * rangeOf(model_);
    if (!declared.known()) {
      check.sentence = check.estimated ? found + "; no surface is declared" : openText(estimate_);
    } else if (agrees(principalCurvatures(declared))) {
      check.verdict = ShapeVerdict::kAgrees;
      check.sentence = found + ", which agrees with " + declaredText(declared);
    } else if (estimate_.beyond) {
      check.sentence = abstention(unfit(model_));
    } else {
      check.verdict = ShapeVerdict::kDisagrees;
      check.sentence = found + ", but the surface file says " + declaredText(declared);
    }
  }

  const ShapeModel& model_;
  const RestReading& rest_;
  ShapeReader reader_;
  double alarm_;
  ShapeEstimate estimate_;
};

}  // namespace

ShapeCheck checkShape(const ShapeModel& model, const RestReading& rest, const matrix::Surface& declared,
                      double alarm) {
  if (!model.present()) return abstainsBecause(model.missing);
  ShapeCheck check;
  try {
    Comparison(model, rest, alarm).check(declared, check);
  } catch (const settings::InputError& error) {
    return abstainsBecause(error.what());
  }
  return check;
}

ShapeCheck abstainsBecause(const std::string& why) {
  ShapeCheck check;
  check.sentence = abstention(why);
  return check;
}

std::string sensorObstacle(const std::string& serial, const std::string& trained) {
  if (serial.empty() || trained.empty() || serial == trained) return "";
  return "the board is " + serial + ", but the calibration was trained on " + trained +
         "; each sheet has its own rest";
}

std::string temperatureObstacle(double temperature, double low, double high) {
  if (!(temperature < low - kTemperatureMargin) && !(temperature > high + kTemperatureMargin)) return "";
  return "the sheet is at " + settings::fixedText(temperature, 1) + " degrees Celsius, but was trained at " +
         settings::fixedText(low, 1) + " to " + settings::fixedText(high, 1) +
         "; another sensitivity reads like another bend";
}

bool agreesIfConstant(const ShapeModel& model, const RestReading& rest, const matrix::Surface& declared,
                      double alarm) {
  if (!model.present()) return true;
  try {
    return Comparison(model, rest, alarm).agrees(principalCurvatures(declared));
  } catch (const settings::InputError&) {
    return true;
  }
}

bool isKnown(const ShapeModel& model, const BendChange& change) {
  return change.high - change.low <= kWidest * rangeOf(model);
}

std::string fixedText(const ShapeModel& model) {
  if (!model.one_direction)
    return "Direction of the bend, second curvature and twist are unknown: training bends the sheet in "
           "several directions.";
  const matrix::Curvature& bend = model.direction;
  const std::string along = std::abs(bend.x - 1) < 0.02   ? "rows"
                            : std::abs(bend.y - 1) < 0.02 ? "columns"
                                                          : "oblique lines";
  return "Fixed by the surfaces of training: the bend is along the " + along +
         ", its second curvature and twist are as there.";
}

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
