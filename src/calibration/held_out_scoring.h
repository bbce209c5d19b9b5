#pragma once

#include <cstddef>
#include <vector>

#include "calibration/training_scans.h"
#include "compensation/scheme_plan.h"
#include "fsr_pressure_map/calibration/calibration.h"
#include "regression/cross_validation.h"

namespace fsr::calibration {

// When a part of the model is taken because it wins on protocols or sessions that were left out. It may be
// worse than the static answer by 1 % on none of them, and must be better by 2 % in root mean square on all
// of them together.
constexpr double kWorse = 1.01;
constexpr double kWins = 0.98;

/// Scores the held-out readings of a calibration, taxel by taxel: each reading is predicted by the model of
/// its class that was trained without the section of the reading.
class HeldOutScoring {
 public:
  /// `scans` and `plan` must outlive the object.
  HeldOutScoring(const TrainingScans& scans, const compensation::SchemePlan& plan, std::size_t sections,
                 std::size_t taxels);

  /// `models` are those of crossValidateScheme() with held-out deviations. Different taxels may be scored at
  /// the same time. A taxel that is never scored is not part of the scores.
  void scoreTaxel(std::size_t taxel, const std::vector<regression::CrossValidatedModel>& models);

  CalibrationScores summarise(const std::vector<dataset::CurvatureClass>& classes) const;

 private:
  // Contribution of one taxel to the score of one class, or of all together.
  struct TaxelScore {
    double r2;
    double rmse_percent;
    std::size_t within;  // readings within one deviation
  };
  struct TaxelScores {
    std::vector<TaxelScore> scores;          // of each class, then of all together
    std::vector<std::vector<float>> errors;  // [class][scan of the class] [Pa]; NaN = not scored
  };

  Score pool(const std::vector<std::size_t>& classes, std::size_t entry) const;

  const TrainingScans& scans_;
  const compensation::SchemePlan& plan_;
  std::size_t sections_;
  std::vector<TaxelScores> taxels_;  // empty members: not scored
};

}  // namespace fsr::calibration
