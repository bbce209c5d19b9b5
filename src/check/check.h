#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "calibration/stages/shape/shape_check.h"
#include "fsr_pressure_map/calibration/calibration.h"
#include "fsr_pressure_map/dataset/recording.h"

// Is a calibration still good? The life of a sheet over dates is in check/sheet_life.h.
namespace fsr::check {

/// "(0, 3), (2, 9)": row and column of the first eight taxels.
std::string placesText(const std::vector<std::size_t>& taxels, const matrix::Layout& layout);

/// Limits for the errors of a map on new bags, with all defaults.
struct MapLimits {
  double rmse_ratio = 1.3;     ///< RMSE on these bags / RMSE that the calibration expects (ratio)
  double bias_share = 0.03;    ///< mean error / trained range of pressure (ratio)
  double beyond_share = 0.05;  ///< share of readings outside the range of training (ratio)
  double taxel_ratio = 2.0;    ///< a taxel is suspicious from this RMSE / expected RMSE on (ratio)
  double taxel_share = 0.05;   ///< share of suspicious taxels (ratio)
};

/// Errors of the readings of one surface, bag or cycle, or of all together. Without readings the values are
/// NaN.
struct CheckedReadings {
  std::string name;             ///< of the surface or bag; empty = neither
  std::uint64_t readings = 0;   ///< and how many of them were ...
  std::uint64_t within = 0;     ///< off by one stated deviation at most
  std::uint64_t beyond = 0;     ///< outside the range of training
  std::uint64_t unsettled = 0;  ///< taken before the sheet's memory was settled, see the flag HISTORY_SHORT
  double error = 0;             ///< sum, map - chamber [Pa]
  double square = 0;            ///< sum of squares [Pa^2]
  double expected = 0;          ///< likewise of the stated deviations [Pa^2]

  void add(double difference, double deviation, std::uint16_t flags = 0);
  void add(const CheckedReadings& more);
  double share(std::uint64_t of_readings) const { return double(of_readings) / double(readings); }
  double expectedRmse() const { return std::sqrt(expected / double(readings)); }  ///< [Pa]
  double rmse() const { return std::sqrt(square / double(readings)); }            ///< [Pa]
  double bias() const { return error / double(readings); }                        ///< mean error [Pa]
};

/// Errors of the live map on recordings with a pressure reference.
struct MapErrors {
  std::vector<std::string> faults;   ///< where they are larger than in training, a sentence each, worst first
  std::vector<std::string> remarks;  ///< other information for the user
  /// What the calibration promises and these bags cannot show, a sentence each. It is not judged.
  std::vector<std::string> not_shown;
  CheckedReadings whole;
  std::vector<CheckedReadings> surfaces;  ///< of the bags, in their order
  std::vector<CheckedReadings> bags;      ///< in their order
  /// By calibration::kIntervalLevels: |error| that this share of all readings does not exceed [Pa].
  std::array<double, calibration::kIntervalLevels.size()> within = {};
  calibration::TrainedInterval range;    ///< pressures of the training
  std::vector<std::size_t> suspicious;   ///< taxels with much larger errors than in training
  std::vector<std::size_t> dead, stuck;  ///< taxels, as TaxelWatch finds them
  /// Errors of the static answer and with the model of the sheet's memory: all readings; those where the
  /// model was not settled, also by direction; the others by direction, by time since the last reversal and
  /// by protocol.
  /// Empty without a model.
  std::vector<calibration::HistoryScore::Part> history;
  /// Where the calibration expects a tare, each session was checked with the zero of the rest at its start
  /// (where it has one). RMSE of all readings without it [Pa]; NaN = no tare is expected.
  double rmse_without_tare = std::numeric_limits<double>::quiet_NaN();
  std::vector<std::string> not_tared;  ///< sessions without a tare, and why, a sentence each
};

/// Scores a calibration on recordings through the same live path as the calibration node. The expected error
/// is the deviation that the calibration states for each reading, so that a bag at other pressures is judged
/// fairly. Throws InputError if the recordings have no reference or are of another matrix.
MapErrors errorsOfMap(const calibration::Calibration& calibration,
                      const std::vector<dataset::Recording>& recordings, const MapLimits& limits = {});

enum class Verdict {
  kStillGood,   ///< errors are as in training, and no correction is worth a new calibration file
  kCorrected,   ///< a correction wins on cycles that were left out, and mounts alone do not do as much
  kCannotTell,  ///< a correction would win, but mounts alone may do as much
  kTare,        ///< errors are larger than allowed, but not after one tare at the start of each session
  kRecalibrate  ///< errors are larger than allowed, after the best correction where one was asked for
};

/// "still good", "corrected", "cannot tell", "tare", "recalibrate".
std::string verdictName(Verdict verdict);

/// All defaults of a check.
struct CheckOptions {
  MapLimits limits;
  /// Also ask whether a correction of gain and offset is worth it: at least three whole cycles on surfaces of
  /// the training.
  bool correct = false;
  /// The sheet was not taken out since the training, so that no mount differs.
  bool same_mount = false;
  std::string date;  ///< of a correction, ISO 8601, UTC; empty = now
};

/// What has changed at a taxel: it reads `offset + gain * code` where it read `code` when the parent was
/// trained.
struct ReadingChange {
  double gain = 1;
  double offset = 0;  ///< [counts]

  double before(double code) const { return (code - offset) / gain; }
};

/// The models of a change, from the simplest to the richest.
enum class ChangeModel {
  kNone,   ///< nothing has changed
  kSheet,  ///< gain and offset of all taxels are the same
  kTaxels  ///< each taxel has its own, drawn towards those of the sheet
};
constexpr std::size_t kChangeModels = 3;

/// Which model of a change predicts cycles that it was not fitted to best, and what that is worth.
struct CorrectionChoice {
  ChangeModel model = ChangeModel::kNone;  ///< the smallest error on cycles that were left out, all together
  /// RMSE of each model on cycles that were left out, all together [Pa].
  std::array<double, kChangeModels> rmse = {};
  double expected = 0;  ///< RMSE that the parent's stated deviations let expect of the same readings [Pa]
  /// RMSE of the choice itself: each cycle is predicted by the model that was chosen without it [Pa].
  double nested = 0;
  /// Probability of such a gain over ChangeModel::kNone if there is none: one-sided paired t test of the
  /// logarithms of the cycles' mean squared errors, parent against choice.
  double p = 1;
  std::vector<ReadingChange> changes;  ///< [taxels], of `model`, fitted to all cycles
};

/// How much the mounts of a sheet scatter.
struct MountScatter {
  double deviation = std::numeric_limits<double>::quiet_NaN();  ///< of one mount [Pa]; NaN = not known
  std::size_t freedom = 0;                                      ///< degrees of freedom; 0 = not known

  bool known() const { return freedom > 0; }
};

/// The change that all mounts have in common, against what mounts alone do.
struct CommonChange {
  double size = 0;  ///< root mean square of what it does to the pressure [Pa]
  MountScatter scatter;
  /// Probability that mounts alone do as much or more; 1 where their scatter is not known.
  double p = 1;
};

/// A check on mounts that are not those of the training.
struct MountTest {
  std::size_t mounts = 0;  ///< of all surfaces; a recording without a number is of mount 0
  CommonChange sheet;      ///< gain and offset of the whole sheet
  CommonChange taxels;     ///< those of each taxel beside the sheet's
};

/// What a correction is worth.
struct CorrectionCheck {
  CorrectionChoice choice;
  /// RMSE that the map of the parent lets expect on these recordings [Pa]. That of the tables alone, which a
  /// correction moves, is CorrectionChoice::expected.
  double expected = 0;
  std::size_t cycles = 0;
  std::vector<std::string> surfaces;
  std::vector<std::string> remarks;  ///< sentences about the readings
  /// Whether mounts alone do as much; absent where the sheet was not taken out, or no correction wins.
  std::optional<MountTest> mounts;
};

struct CheckResult {
  Verdict verdict = Verdict::kStillGood;
  std::vector<std::string> reasons;  ///< why this verdict, worst first; empty = errors are as in training
  MapErrors map;                     ///< of the calibration, or of its child
  /// How the sheet rests on each mount; empty where the calibration has no model of its shape.
  std::vector<calibration::CheckedMount> at_rest;
  std::optional<CorrectionCheck> correction;      ///< where one was asked for
  std::optional<calibration::Calibration> child;  ///< of kCorrected
};

/// Whether a calibration is still good on recordings with a pressure reference. The same recordings give the
/// same result.
///
/// Without CheckOptions::correct the errors of the map decide: kStillGood or kRecalibrate.
///
/// A correction is taken where all of these hold:
///   - on cycles that were left out its error is smaller, and chance makes that so in 1 % of the cases at
///     most (one-sided);
///   - the parent's RMSE is more than 1.1 times that of the correction. A smaller gain is not worth a new
///     calibration file;
///   - the sheet was not taken out since the training, or what all mounts have in common is more than mounts
///     alone do, at 5 % (testCommonChange()). A correction by taxel must pass that test, too.
/// Where only the last one does not hold, the verdict is kCannotTell, or kStillGood where the deviations of
/// the parent contain its mounts. The verdict is kRecalibrate where the errors of the best of parent and
/// correction are beyond the limits, or its error on cycles that were left out is; kCannotTell where new
/// mounts, of which the deviations say nothing, may explain that: no taxel is dead or stuck, and gains and
/// offsets of each mount alone leave errors within the limit.
///
/// Throws InputError, one sentence: what errorsOfMap() refuses; with a correction what gatherCycles()
/// refuses, a parent that is a correction itself, and several mounts of a surface of a sheet that was not
/// taken out.
CheckResult check(const calibration::Calibration& calibration,
                  const std::vector<dataset::Recording>& recordings, const CheckOptions& options = {});

/// Throws InputError, one sentence, if the calibration is a correction itself.
void requireTrained(const calibration::Calibration& parent);

/// "corrected on 2026-11-23 from 3f2a01c4d5e6"; "" for a calibration that was trained.
std::string correctionText(const calibration::Correction& correction);

/// A correction needs at least so many cycles, so that one can be left out and two tell their scatter.
constexpr std::size_t kLeastCycles = 3;

/// The least span of a cycle that counts: three quarters of the trained range [Pa]. A smaller cycle runs
/// through another loop of the sheet than those of the training, which looks like a change, and gain and
/// offset cannot be told apart at one pressure.
double leastCycleSpan(const calibration::Calibration& parent);

/// Number of cycles in a series of pressures [Pa] that count. `running`: whether the last one does, although
/// it may not have ended.
std::size_t countCycles(const std::vector<double>& pressure, double least, bool& running);

}  // namespace fsr::check
