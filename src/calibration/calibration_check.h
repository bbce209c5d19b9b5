#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "fsr_pressure_map/calibration/calibration.h"
#include "fsr_pressure_map/dataset/recording.h"

namespace fsr::calibration {

/// What a calibration is allowed to be off on new bags; every default stands here.
struct CalibrationCheckOptions {
  double rmse_ratio = 1.3;     ///< of the RMSE here to the one that the calibration expects (ratio)
  double bias_share = 0.03;    ///< mean error, of the trained range of pressure (ratio)
  double beyond_share = 0.05;  ///< readings outside of training (ratio)
  double taxel_ratio = 2.0;    ///< a taxel of this ratio of its own errors is conspicuous (ratio)
  double taxel_share = 0.05;   ///< conspicuous taxels, of all (ratio)
};

/// How the readings of one curvature class, or of all, fared.
struct CheckedClass {
  std::string name;  ///< of the surface; empty = all together
  std::uint64_t readings = 0;
  double expected_rmse = std::numeric_limits<double>::quiet_NaN();  ///< of held-out readings in training [Pa]
  double rmse = std::numeric_limits<double>::quiet_NaN();           ///< here [Pa]
  double bias = std::numeric_limits<double>::quiet_NaN();           ///< mean error here, map - chamber [Pa]
  double within_one_deviation = std::numeric_limits<double>::quiet_NaN();  ///< of the readings (ratio)
  double beyond_training = std::numeric_limits<double>::quiet_NaN();       ///< of the readings (ratio)
};

struct CalibrationCheck {
  bool still_good = false;
  std::vector<std::string> reasons;  ///< why not, worst first; empty where it is
  std::vector<std::string> remarks;  ///< what else a user should know
  CheckedClass whole;
  std::vector<CheckedClass> classes;     ///< of each surface of the bags, in their order
  std::vector<std::size_t> suspicious;   ///< taxels that err far more than they did in training
  std::vector<std::size_t> dead, stuck;  ///< taxels, as TaxelWatch finds them
};

/// Scores a stored calibration on new recordings with a pressure reference, as the calibration node would
/// use it: does it still do what it did when it was made? The expected error is the deviation that the
/// calibration itself states for each reading, so that a bag at other pressures is judged fairly. Throws
/// InputError where the recordings have no reference or are of another matrix.
CalibrationCheck checkCalibration(const Calibration& calibration,
                                  const std::vector<dataset::Recording>& recordings,
                                  const CalibrationCheckOptions& options = {});

}  // namespace fsr::calibration
