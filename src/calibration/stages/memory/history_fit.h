#pragma once

#include <Eigen/Dense>
#include <cstddef>
#include <limits>
#include <vector>

#include "calibration/stages/memory/history_state.h"
#include "fsr_pressure_map/calibration/history.h"

namespace fsr::calibration {

/// What a history model may be made of.
struct HistoryGrid {
  std::vector<double> knots;           ///< of the correction c [Pa]
  std::vector<double> radii;           ///< of the plays [Pa]
  std::vector<double> time_constants;  ///< of the memories [s]
  std::size_t continued = 0;           ///< of the time constants, the last ones: longer than can be measured

  /// c at each knot, then the operators.
  std::size_t features() const { return knots.size() + radii.size() + time_constants.size(); }
  double longestMeasured() const { return time_constants[time_constants.size() - 1 - continued]; }  ///< [s]
};

/// The grid for pressures from `lowest` to `highest` [Pa] whose longest hold or rest is `longest_hold` [s]. A
/// memory that is longer than a third of it cannot be told from drift or a standing load by itself. Creep
/// goes on as the logarithm of time, so one more decade of times continues those that are measured.
HistoryGrid historyGrid(double lowest, double highest, double longest_hold);

/// The features of one sample: shares of the two knots around x, and operator - x for each operator.
/// `features` has grid.features() entries; `state` is that of operatorsOf(grid).
void historyFeatures(const HistoryGrid& grid, double x, const double* state, double* features);

HistoryOperators operatorsOf(const HistoryGrid& grid);

/// Normal equations of samples (features, target); target = p - x [Pa]. Sums of different taxels add up.
class HistorySums {
 public:
  explicit HistorySums(std::size_t features)
      : gram_(Eigen::MatrixXd::Zero(Eigen::Index(features + 1), Eigen::Index(features + 1))),
        rows_(Eigen::Index(features + 1), kBlock) {}

  /// Adds a sample. finish() must follow the last one; after it no sample can be added.
  void add(const double* features, double target);
  void finish();
  /// Both must be finished.
  void merge(const HistorySums& other);

  double samples() const { return samples_; }
  /// Of the target beside `coefficients` [Pa^2]; with coefficients of zero that of the static answer.
  double meanSquare(const Eigen::VectorXd& coefficients) const;
  /// [features + 1], the target last; the upper half is filled too.
  const Eigen::MatrixXd& gram() const { return gram_; }

 private:
  static constexpr Eigen::Index kBlock = 32;
  void addBlock();
  Eigen::MatrixXd gram_;
  Eigen::MatrixXd rows_;  // samples that are not added yet, one in each column
  Eigen::Index waiting_ = 0;
  double samples_ = 0;
};

/// The coefficients of the correction c alone, 0 for all operators.
Eigen::VectorXd fitCorrection(const HistoryGrid& grid, const HistorySums& sums);

/// The coefficients of a family, [features] of the grid, 0 for operators that it does not have. Least squares
/// with a small ridge on the weights, and a larger one on the differences between the weights of the longest
/// memories, from the longest that is measured on: creep has equal weights by the logarithm of time. All
/// weights of plays have one sign, and all of memories: the sign with
/// which the fit is better.
Eigen::VectorXd fitHistory(HistoryFamily family, const HistoryGrid& grid, const HistorySums& sums);

/// Root mean square of memory - x, [memories of the grid] [Pa].
std::vector<double> memorySpreads(const HistoryGrid& grid, const HistorySums& sums);

/// The smallest and the largest change p - x of the readings near each knot of a grid [Pa].
class ChangeRange {
 public:
  explicit ChangeRange(const HistoryGrid& grid)
      : grid_(&grid), least_(grid.knots.size(), kNone), largest_(grid.knots.size(), -kNone) {}
  void add(double x, double change);
  void merge(const ChangeRange& other);
  /// Knots without readings take the range of their neighbour. Follows the last add() and merge().
  void finish();
  double limited(double x, double change) const;
  const std::vector<double>& least() const { return least_; }
  const std::vector<double>& largest() const { return largest_; }

 private:
  static constexpr double kNone = std::numeric_limits<double>::infinity();
  const HistoryGrid* grid_;
  std::vector<double> least_, largest_;  // [knots]
};

/// The model of these coefficients and spreads. Operators that move the answer by less than 0.01 % of the
/// range are left out. Its deviation is empty.
HistoryModel historyModel(HistoryFamily family, const HistoryGrid& grid, const Eigen::VectorXd& coefficients,
                          const std::vector<double>& spreads);

}  // namespace fsr::calibration
