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
      compensation::Scheme::kInterpolated;  ///< as kPerCurvature on trained surfaces, better between them
  regression::RegressorOptions regressor;   ///< the model; the seed of a forest is `seed`
  /// GRNN: choose the bandwidth by nested cross-validation and ignore that of `regressor`.
  bool choose_bandwidth = true;
  std::size_t folds = 5;   ///< number of sections of each condition, 2 to 20
  bool scores = true;      ///< compute cross-validated scores; the deviation is held out in any case
  std::uint64_t seed = 1;  ///< of the forest; stored in the file
  unsigned threads = 0;    ///< 0 = one for each core; the results do not depend on it
  std::string date;        ///< ISO 8601, UTC; empty = now
};

/// Input of calibrate().
struct CalibrationProblem {
  std::vector<dataset::Recording> recordings;
  CalibrationOptions options;
};

struct SourceBag {
  std::string name;    ///< base name
  std::string sha256;  ///< hexadecimal; empty if the recording came over topics
  std::uint64_t scans = 0;
};

/// Origin of a calibration.
struct Provenance {
  std::string tool_version;
  std::string date;  ///< ISO 8601, UTC
  std::uint64_t seed = 0;
  std::vector<SourceBag> bags;
};

/// Everything that converts scans to pressure, with its accuracy.
struct Calibration {
  std::string id;  ///< first hex digits of the hash of its file; empty until it is saved or loaded
  regression::RegressorOptions regressor;  ///< the model; for a GRNN with its bandwidth, chosen or given
  bool bandwidth_chosen = false;           ///< from the data, not given by the user
  std::size_t folds = 0;
  dataset::SensorIdentity sensor;
  matrix::Layout layout;
  /// [taxels], 1 = the taxel has no model: masked in the bags, or its reading never changed. Its tables are
  /// NaN.
  std::vector<std::uint8_t> no_model;
  std::vector<std::uint8_t> masked;  ///< [taxels], 1 = masked in the bags
  compensation::CurvatureTables tables;
  TrainedRanges trained;
  dataset::Coverage coverage;
  CalibrationScores scores;
  Provenance provenance;
  /// Sums behind the tables, from which merging trains anew. Null: the file was loaded without them.
  std::shared_ptr<const compensation::TrainingStatistics> statistics;
  std::vector<std::string> warnings;  ///< sentences for the user
};

/// Throws InputError: one sentence that names the first problem and what would be right.
void validate(const CalibrationProblem& problem);

/// Called after each taxel, from one thread at a time.
using CalibrationProgress = std::function<void(std::size_t done, std::size_t taxels)>;

/// Trains a calibration: tables, scores and provenance from recordings. Validates the problem first. The
/// result is the same on any number of threads.
Calibration calibrate(const CalibrationProblem& problem, const CalibrationProgress& progress = {});

}  // namespace fsr::calibration
