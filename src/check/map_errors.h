#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "fsr_pressure_map/calibration/calibration.h"
#include "fsr_pressure_map/dataset/recording.h"

namespace fsr::check {

/// Limits for the errors of a map on new bags, with all defaults.
struct MapLimits {
  double rmse_ratio = 1.3;     ///< RMSE on these bags / RMSE that the calibration expects (ratio)
  double bias_share = 0.03;    ///< mean error / trained range of pressure (ratio)
  double beyond_share = 0.05;  ///< share of readings outside the range of training (ratio)
  double taxel_ratio = 2.0;    ///< a taxel is suspicious from this RMSE / expected RMSE on (ratio)
  double taxel_share = 0.05;   ///< share of suspicious taxels (ratio)
};

/// Errors of the readings of one surface or bag, or of all together.
struct CheckedReadings {
  std::string name;  ///< of the surface or bag; empty = all together
  std::uint64_t readings = 0;
  double expected_rmse = std::numeric_limits<double>::quiet_NaN();  ///< of held-out readings in training [Pa]
  double rmse = std::numeric_limits<double>::quiet_NaN();           ///< here [Pa]
  double bias = std::numeric_limits<double>::quiet_NaN();           ///< mean error here, map - chamber [Pa]
  double within_one_deviation = std::numeric_limits<double>::quiet_NaN();  ///< of the readings (ratio)
  double beyond_training = std::numeric_limits<double>::quiet_NaN();       ///< of the readings (ratio)
  /// Of the readings: the sheet's memory was not settled, see the flag HISTORY_SHORT (ratio).
  double not_settled = std::numeric_limits<double>::quiet_NaN();
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
  /// Errors of the static answer and with the model of the sheet's memory: all readings, those where the
  /// model was not settled, and of the others by direction, by time since the last reversal, by protocol.
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

}  // namespace fsr::check
