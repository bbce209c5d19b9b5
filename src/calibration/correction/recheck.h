#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calibration/calibration_check.h"
#include "calibration/correction/common_change.h"
#include "calibration/correction/correction_choice.h"
#include "fsr_pressure_map/calibration/calibration.h"

namespace fsr::calibration {

enum class RecheckVerdict {
  kStillGood,   ///< a correction would not help enough to be worth a new calibration file
  kCorrected,   ///< a correction wins on cycles that were left out, and mounts alone do not do as much
  kCannotTell,  ///< a correction would win, but mounts alone may do as much
  kRecalibrate  ///< even the best correction leaves errors larger than `train --check` allows
};

/// "still good", "corrected", "cannot tell", "recalibrate".
std::string verdictName(RecheckVerdict verdict);

/// When a correction is taken, with all defaults.
struct RecheckOptions {
  /// Probability of taking a correction that gains nothing on cycles that were left out (one-sided).
  double error_rate = 0.01;
  /// The parent is still good as long as its RMSE is at most this many times that of the correction on cycles
  /// that were left out: what a correction shall reach of a new calibration.
  double worth = 1.1;
  /// The sheet was not taken out since the training, so that no mount differs.
  bool same_mount = false;
  /// Otherwise the probability of taking a correction where only the mounts differ. A correction by taxel
  /// must pass the same test once more.
  double mount_error_rate = 0.05;
  CalibrationCheckOptions check;  ///< limits of `train --check`
  std::string date;               ///< ISO 8601, UTC; empty = now
};

/// Rest and full pressure on one surface: is a calibration still good?
struct Recheck {
  RecheckVerdict verdict = RecheckVerdict::kStillGood;
  std::vector<std::string> reasons;  ///< sentences: why this verdict
  std::vector<std::string> remarks;  ///< other information for the user
  CorrectionChoice choice;
  /// RMSE that the map of the parent lets expect on these recordings, as checkCalibration() says [Pa]. That
  /// of the tables alone, which a correction moves, is CorrectionChoice::expected.
  double expected = 0;
  std::size_t cycles = 0;
  std::vector<std::string> surfaces;
  /// Whether mounts alone do as much; absent where the sheet was not taken out, or no correction wins.
  std::optional<MountTest> mounts;
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
///   - the sheet was not taken out since the training, or what all mounts have in common is more than mounts
///     alone do, at `mount_error_rate` (testCommonChange()).
/// Where only the last one does not hold, the verdict is kCannotTell, or kStillGood where the deviations of
/// the parent contain its mounts. The verdict is kRecalibrate where the best of parent and correction does
/// not pass `train --check`, or its error on cycles that were left out is above the limit there; kCannotTell
/// where new mounts, of which the deviations say nothing, may explain that: no taxel is dead or stuck, and
/// gains and offsets of each mount alone leave errors within the limit.
///
/// Throws InputError, one sentence: what gatherRecheck() refuses, a parent that is a correction itself, and
/// several mounts of a surface of a sheet that was not taken out.
Recheck recheckCalibration(const Calibration& parent, const std::vector<dataset::Recording>& recordings,
                           const RecheckOptions& options = {});

}  // namespace fsr::calibration
