#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "calibration/calibration_check.h"
#include "calibration/correction/correction_choice.h"
#include "fsr_pressure_map/calibration/calibration.h"

namespace fsr::calibration {

enum class RecheckVerdict {
  kStillGood,   ///< a correction would not help enough to be worth a new calibration file
  kCorrected,   ///< a correction wins on cycles that were left out
  kRecalibrate  ///< even the best correction leaves errors larger than `train --check` allows
};

/// "still good", "corrected", "recalibrate".
std::string verdictName(RecheckVerdict verdict);

/// When a correction is taken, with all defaults.
struct RecheckOptions {
  /// Probability of taking a correction that gains nothing on cycles that were left out (one-sided).
  double error_rate = 0.01;
  /// The parent is still good as long as its RMSE is at most this many times that of the correction on cycles
  /// that were left out: what a correction shall reach of a new calibration.
  double worth = 1.1;
  CalibrationCheckOptions check;  ///< limits of `train --check`
  std::string date;               ///< ISO 8601, UTC; empty = now
};

/// Rest and full pressure on one surface: is a calibration still good?
struct Recheck {
  RecheckVerdict verdict = RecheckVerdict::kStillGood;
  std::vector<std::string> reasons;  ///< sentences: why this verdict
  std::vector<std::string> remarks;  ///< other information for the user
  CorrectionChoice choice;
  std::size_t cycles = 0;
  std::vector<std::string> surfaces;
  /// RMSE that the correction takes away, and what another mount alone changes [Pa]; NaN = the parent was not
  /// trained on several mounts of a surface, so that mount and wear cannot be told apart.
  double removed = 0;
  double mount = std::numeric_limits<double>::quiet_NaN();
  /// The parent, or its child, on all readings of the recheck, as `train --check` shows it.
  CalibrationCheck check;
  std::optional<Calibration> child;  ///< of kCorrected
};

/// Throws InputError, one sentence, if the calibration is a correction itself.
void requireTrained(const Calibration& parent);

/// Rechecks a calibration on recordings with a pressure reference: at least three cycles on surfaces that it
/// was trained on. The same recordings give the same result.
///
/// A correction is taken where all of these hold:
///   - on cycles that were left out its error is smaller, and chance makes that so with `error_rate` at most;
///   - the parent's RMSE is more than `worth` times that of the correction;
///   - it takes away more than another mount changes, at the same error rate (normal, two-sided), where the
///     parent knows how much that is.
/// The verdict is kRecalibrate where what is then the best does not pass `train --check`, or its error on
/// cycles that were left out is above the limit there.
///
/// Throws InputError, one sentence: what gatherRecheck() refuses, and a parent that is a correction itself.
Recheck recheckCalibration(const Calibration& parent, const std::vector<dataset::Recording>& recordings,
                           const RecheckOptions& options = {});

}  // namespace fsr::calibration
