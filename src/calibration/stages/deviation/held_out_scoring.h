#pragma once

#include <cstddef>
#include <mutex>
#include <optional>
#include <vector>

#include "calibration/stages/deviation/budget_sums.h"
#include "calibration/stages/deviation/interval_tally.h"
#include "calibration/stages/tables/training_scans.h"
#include "compensation/scheme_plan.h"
#include "fsr_pressure_map/calibration/calibration.h"
#include "regression/cross_validation.h"
#include "statistics/error_bins.h"

namespace fsr::calibration {

// When a part of the model is taken because it wins on protocols or sessions that were left out. It may be
// worse than the static answer by 1 % on none of them, and must be better by 2 % in root mean square on all
// of them together.
constexpr double kWorse = 1.01;
constexpr double kWins = 0.98;

/// What the error budget needs to know of the scans.
struct BudgetInput {
  BudgetScale scale;
  BudgetCycles cycles;
  bool of_cycles = true;  ///< whether the intervals are those of new cycles; else nothing is counted for them
};

/// Scores the held-out readings of a calibration, taxel by taxel: each reading is predicted by the model of
/// its class that was trained without the section of the reading.
class HeldOutScoring {
 public:
  /// All of them must outlive the object. `divided`: the recordings in sections.
  HeldOutScoring(const TrainingScans& scans, const std::vector<dataset::Sections>& divided,
                 const compensation::SchemePlan& plan, const BudgetInput& budget, std::size_t sections,
                 std::size_t taxels);

  /// `models` are those of crossValidateScheme() with held-out deviations. Different taxels may be scored at
  /// the same time.
  void scoreTaxel(std::size_t taxel, const std::vector<regression::CrossValidatedModel>& models);
  /// The taxel has no model and is not part of the scores.
  void leaveOut(std::size_t taxel);

  /// After each taxel was scored or left out.
  CalibrationScores summarise(const std::vector<dataset::CurvatureClass>& classes) const;
  /// The sums of the error budget, of the classes that the models were trained on.
  const BudgetSums& budget() const { return budget_sums_; }
  /// The intervals of the held-out readings. Their units are cycles.
  ErrorIntervals intervals() const { return intervals_.summarise(); }

 private:
  // Contribution of one taxel to the score of one class, or of all together.
  struct TaxelScore {
    double r2;
    double rmse_percent;
    std::size_t within;  // readings within one deviation
  };
  struct TaxelScores {
    std::vector<TaxelScore> scores;             // of each class, then of all together; empty = left out
    std::vector<statistics::ErrorBins> errors;  // [classes]; empty once they are added to those of all taxels
    BudgetSums budget;
  };

  void addErrors(std::size_t taxel, TaxelScores scored);
  Score pool(const statistics::ErrorBins& errors, std::size_t entry) const;

  const TrainingScans& scans_;
  const std::vector<dataset::Sections>& divided_;
  const compensation::SchemePlan& plan_;
  const BudgetInput& budget_;
  std::size_t sections_;
  IntervalTally intervals_;
  std::mutex adding_;
  std::vector<std::optional<TaxelScores>> taxels_;
  std::size_t next_ = 0;                       // taxel whose errors are added next
  std::vector<statistics::ErrorBins> errors_;  // [classes], of the taxels before `next_`
  BudgetSums budget_sums_;                     // likewise
};

}  // namespace fsr::calibration
