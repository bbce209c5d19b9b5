#pragma once

#include <Eigen/Dense>
#include <cstddef>
#include <vector>

namespace fsr::discrepancy {

/// Coefficients that minimise b' G b - 2 b' r, those not `free` non-negative. G: symmetric, positive
/// semidefinite. Source: C. Lawson, R. Hanson, Solving Least Squares Problems, 1974, ch. 23, on the
/// normal equations.
Eigen::VectorXd solveSigned(const Eigen::MatrixXd& gram, const Eigen::VectorXd& right,
                            const std::vector<bool>& free);

/// Inner products of columns with each other and with the target, by cycle: after them no fit looks at
/// a scan again.
class CycleGrams {
 public:
  /// `columns` [scans x columns], the last one the target; ranges of scans, one for each cycle.
  CycleGrams(const Eigen::MatrixXd& columns, const std::vector<std::pair<std::size_t, std::size_t>>& ranges,
             unsigned threads);

  std::size_t cycles() const { return grams_.size(); }
  Eigen::Index target() const { return target_; }
  const Eigen::MatrixXd& of(std::size_t cycle) const { return grams_[cycle]; }

  /// Sum over the cycles with `wanted`.
  Eigen::MatrixXd sum(const std::vector<bool>& wanted) const;

 private:
  Eigen::Index target_ = 0;
  std::vector<Eigen::MatrixXd> grams_;
};

/// Columns that are fitted together, and what is known of each.
struct ColumnSet {
  std::vector<Eigen::Index> columns;
  std::vector<bool> free;       ///< of sign
  std::vector<bool> bent_only;  ///< it acts where the surface is bent, and nowhere else
};
ColumnSet together(const ColumnSet& a, const ColumnSet& b);

/// The set's part of a gram, the target last; `flat`: of cycles where the surface is flat.
Eigen::MatrixXd partOf(const Eigen::MatrixXd& gram, const ColumnSet& set, bool flat);

/// Coefficients of the set by its part of the sum of grams.
Eigen::VectorXd fitColumns(const Eigen::MatrixXd& part, const ColumnSet& set);

/// Squared error with these coefficients.
double squaredError(const Eigen::MatrixXd& part, const Eigen::VectorXd& coefficients);

}  // namespace fsr::discrepancy
