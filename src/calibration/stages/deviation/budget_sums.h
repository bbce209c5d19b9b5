#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "calibration/stages/tables/training_scans.h"
#include "dataset/sections.h"
#include "fsr_pressure_map/calibration/calibration.h"
#include "fsr_pressure_map/calibration/error_budget.h"
#include "fsr_pressure_map/dataset/condition_classes.h"
#include "fsr_pressure_map/dataset/recording.h"
#include "statistics/samples.h"

namespace fsr::calibration {

/// Where a cycle belongs. Numbers start at 0.
struct BudgetCycle {
  std::uint32_t session = 0;  ///< of its class: a condition of a recording
  std::uint32_t mount = 0;    ///< of its class
  std::uint32_t unit = 0;     ///< of all classes, see IntervalUnit::kCycles
};

/// The cycles of each class, by TrainingScan::cycle.
struct BudgetCycles {
  /// So many units at most: neighbouring cycles are one unit where there are more.
  static constexpr std::size_t kMostUnits = 64;

  std::vector<std::vector<BudgetCycle>> of_class;  ///< [classes][cycles]
  std::size_t units = 0;
};

BudgetCycles budgetCycles(const std::vector<dataset::Recording>& recordings,
                          const dataset::ConditionClasses& classes,
                          const std::vector<dataset::Sections>& sections);

/// The pressures of a budget, and the readings that count for each.
struct BudgetScale {
  static constexpr double kHalfWindow = 0.05;  ///< share of the trained range: readings this near count
  static constexpr double kDwellReach = 0.15;  ///< share of the range: dwells this near count

  explicit BudgetScale(const TrainedInterval& trained);

  double range;           ///< [Pa]
  double highest;         ///< trained [Pa]
  BudgetValues pressure;  ///< [Pa]
  /// The point whose window contains a pressure; kBudgetShares.size() = none.
  std::size_t pointOf(double pressure) const;
};

/// The codes of a table in the window of one of the pressures. A straight line through the window gives the
/// step.
struct CodeSpan {
  CodeSpan(const regression::CodeTable& table, const BudgetScale& scale, std::size_t point);

  double step = std::numeric_limits<double>::quiet_NaN();  ///< [Pa] a count; NaN = the table ends before
  std::size_t middle = 0;                                  ///< code
};

/// Sums of squares at one pressure, over taxels and classes. Squares in Pa^2. Where the noise of the means
/// inside is subtracted, a sum may be negative.
struct BudgetPoint {
  double held_out = 0, cells = 0;  ///< mean square of each cycle and direction, and their number
  double noise = 0, steps = 0;     ///< half the squared step from reading to reading, and their number
  /// Squared differences of cycles from their session's mean in one direction, and their degrees of freedom;
  /// `repeat_noise`: the part of one reading's noise variance that is in them.
  double repeat = 0, repeat_freedom = 0, repeat_noise = 0;
  double loop = 0, loops = 0;  ///< squared half difference of the directions of a session, and their number
  double dwell = 0, dwell_freedom = 0;      ///< squared counts from the mean of a dwell, in Pa^2
  double dwell_noise = 0, dwell_steps = 0;  ///< half the squared step within a dwell, likewise
  double dwells = 0, dwells_inside = 0;     ///< their number, and of those in the window of the point
  double mount = 0, mount_freedom = 0;      ///< squared differences of mounts from the mean of their surface
  /// From the first cycle of a mount to the later ones: squared change of the answer, its sum [Pa], and the
  /// number of changes. The scatter of the later cycles is subtracted from the square.
  double first = 0, first_change = 0, firsts = 0;
  double surfaces = 0, mount_shares = 0;  ///< number of classes, and the sum of 1 / number of mounts

  void add(const BudgetPoint& more);
};
using BudgetSums = std::array<BudgetPoint, kBudgetShares.size()>;
void addSums(const BudgetSums& more, BudgetSums& sums);

/// Collects the errors of one taxel on one class, scan by scan in the order of TrainingScans. Its memory
/// grows with the number of cycles, not of scans.
class BudgetTally {
 public:
  /// `scale`, `cycles` and `table` must outlive the object. `cycles`: of the class; `table`: of the taxel on
  /// it, from all scans.
  BudgetTally(const BudgetScale& scale, const std::vector<BudgetCycle>& cycles,
              const regression::CodeTable& table);

  /// `error`: of a model that was trained without the scan [Pa].
  void add(const TrainingScan& scan, double error);
  /// After the last scan.
  BudgetSums sums();

 private:
  static constexpr std::size_t kDirections = 2;

  // Readings of one cycle in one direction near one of the pressures.
  struct Cell {
    double count = 0, sum = 0, squares = 0;
    double answers = 0;  // of `table_`, less the pressure of the chamber
  };
  // Cycles of one session in one direction.
  struct Side {
    statistics::RunningMoments cycles;
    double inverse_counts = 0;  // of the readings of each cycle

    double varianceOfMean() const;
  };

  Cell& cell(std::size_t point, std::size_t cycle, std::size_t direction) {
    return cells_[(point * cycles_.size() + cycle) * kDirections + direction];
  }
  void addFirstCycles(std::size_t point);
  void addDwell(const TrainingScan& scan);
  void endDwell();
  std::vector<std::array<Side, kDirections>> sidesOf(std::size_t point);
  void addSessions(const std::vector<std::array<Side, kDirections>>& sides, BudgetPoint& sums) const;

  const BudgetScale& scale_;
  const std::vector<BudgetCycle>& cycles_;
  const regression::CodeTable& table_;
  BudgetValues step_;  // of one count [Pa]
  std::vector<std::uint32_t> mount_of_session_;
  std::vector<Cell> cells_;
  BudgetSums sums_;
  const Cell* last_cell_ = nullptr;  // of the scan before, null = none
  double last_error_ = 0;
  statistics::RunningMoments dwell_;  // of the codes
  double dwell_noise_ = 0;            // sum of half the squared steps
  std::uint16_t dwell_code_ = 0;
  double dwell_pressure_ = 0;  // sum [Pa]
  std::uint16_t dwell_cycle_ = 0;
};

}  // namespace fsr::calibration
