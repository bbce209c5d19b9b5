#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "calibration/stages/shape/mounted_rests.h"
#include "fsr_pressure_map/calibration/calibration.h"
#include "fsr_pressure_map/calibration/shape.h"
#include "fsr_pressure_map/matrix/curvature.h"

namespace fsr::calibration {

/// What the readings of the unloaded sheet say of the surface that is declared.
enum class ShapeVerdict {
  kAgrees,     ///< the sheet rests as the surface says
  kDisagrees,  ///< it rests as on another surface
  kUnknown     ///< it abstains
};

struct ShapeCheck {
  ShapeVerdict verdict = ShapeVerdict::kUnknown;
  std::string sentence;  ///< for the user: what was found, or why nothing can be said
  ShapeEstimate estimate;
  ChangingBend change;
  /// A bend that changes along the sheet explains the readings far better than a constant one.
  bool changes = false;
  std::vector<std::string> possible;  ///< names of the surfaces of training that would agree
  /// The estimate may be used: it is within training, and its interval is at most half of the training.
  bool estimated = false;
};

/// Largest probability with which a correct surface is called wrong.
constexpr double kShapeAlarm = 0.005;

/// Compares a declared surface with the readings of the sheet, which must be unloaded. `alarm`: probability
/// with which a correct surface may be called wrong. If the bend seems to change along the sheet, it
/// abstains: a load on a part of the sheet reads alike.
ShapeCheck checkShape(const ShapeModel& model, const RestReading& rest, const matrix::Surface& declared,
                      double alarm = kShapeAlarm);

/// Why a sheet at this temperature cannot be compared with a training between `low` and `high` [degree
/// Celsius]; empty = it can, or one of them is not known (NaN).
std::string temperatureObstacle(double temperature, double low, double high);

/// Why a sheet on a board with this serial number cannot be compared with a training on that of `trained`;
/// empty = it can, or one of them is not known (empty).
std::string sensorObstacle(const std::string& serial, const std::string& trained);

/// A check that abstains for this reason.
ShapeCheck abstainsBecause(const std::string& why);

/// Whether the declared surface agrees as far as constant bends tell, or nothing can be told. Much faster
/// than checkShape().
bool agreesIfConstant(const ShapeModel& model, const RestReading& rest, const matrix::Surface& declared,
                      double alarm);

/// Whether the readings bound the change: its interval is at most half of the training.
bool isKnown(const ShapeModel& model, const BendChange& change);

/// What is fixed by the training, and so not told by the readings: a sentence.
std::string fixedText(const ShapeModel& model);

/// That the readings do not tell the curvature, and what they leave open.
std::string openText(const ShapeEstimate& estimate);

/// "the sheet rests as on 5.0 cm (4.9 cm to 5.1 cm)".
std::string restText(const ShapeEstimate& estimate);

/// "5.0 cm", for a principal curvature; "flat" up to dataset::kFlatCurvature.
std::string bendText(double curvature);

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
