#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "fsr_pressure_map/calibration/scores.h"
#include "fsr_pressure_map/calibration/trained_ranges.h"
#include "fsr_pressure_map/compensation/curvature_tables.h"
#include "fsr_pressure_map/dataset/coverage.h"
#include "fsr_pressure_map/dataset/recording.h"
#include "fsr_pressure_map/regression/regressor_options.h"

namespace fsr::compensation {
struct TrainingStatistics;
}

namespace fsr::calibration {

struct CalibrationOptions {
  compensation::Scheme scheme =
      compensation::Scheme::kInterpolated;  ///< as kPerCurvature on surfaces of training, better between them
  regression::RegressorOptions regressor;   ///< which model; its forest's seed is `seed`
  /// Of a GRNN, by nested cross-validation; the one among the regressor's options is not looked at then.
  bool choose_bandwidth = true;
  std::size_t folds = 5;   ///< sections of each condition, 2 to 20
  bool scores = true;      ///< cross-validated scores; the deviation is held out either way
  std::uint64_t seed = 1;  ///< of the forest; kept in the file
  unsigned threads = 0;    ///< 0 = one for each core; the numbers do not depend on it
  std::string date;        ///< ISO 8601, UTC; empty = now
};

/// Bags in.
struct CalibrationProblem {
  std::vector<dataset::Recording> recordings;
  CalibrationOptions options;
};

struct SourceBag {
  std::string name;    ///< base name
  std::string sha256;  ///< hexadecimal; empty where the recording came over topics
  std::uint64_t scans = 0;
};

/// Where the numbers come from.
struct Provenance {
  std::string tool_version;
  std::string date;  ///< ISO 8601, UTC
  std::uint64_t seed = 0;
  std::vector<SourceBag> bags;
};

/// Everything that turns scans into pressure, and what is known of how well.
struct Calibration {
  std::string id;  ///< first hex digits of its file's hash; empty until it was saved or loaded
  regression::RegressorOptions regressor;  ///< the model; of a GRNN with its bandwidth, chosen or told
  bool bandwidth_chosen = false;           ///< from the data, and not told
  std::size_t folds = 0;
  dataset::SensorIdentity sensor;
  matrix::Layout layout;
  /// 1 = this taxel has no model: masked in the bags, or its reading never changed. Its tables are
  /// NaN. One value for each taxel.
  std::vector<std::uint8_t> no_model;
  std::vector<std::uint8_t> masked;  ///< 1 = masked in the bags, likewise
  compensation::CurvatureTables tables;
  TrainedRanges trained;
  dataset::Coverage coverage;
  CalibrationScores scores;
  Provenance provenance;
  /// Sums behind the tables, from which merging trains anew. Null: the file was loaded without them.
  std::shared_ptr<const compensation::TrainingStatistics> statistics;
  std::vector<std::string> warnings;  ///< sentences for the user
};

/// Throws InputError: one sentence that names the first thing in the way and what would be right.
void validate(const CalibrationProblem& problem);

/// Called after each taxel, from one thread at a time.
using CalibrationProgress = std::function<void(std::size_t done, std::size_t taxels)>;

/// Bags in -> tables, scores, provenance out. Validates first. The same numbers on any number of
/// threads.
Calibration calibrate(const CalibrationProblem& problem, const CalibrationProgress& progress = {});

}  // namespace fsr::calibration
