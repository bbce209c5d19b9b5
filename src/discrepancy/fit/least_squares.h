#pragma once

#include <Eigen/Dense>
#include <cstddef>
#include <vector>

namespace fsr::discrepancy {

/// Returns the coefficients b that minimise b' G b - 2 b' r. Coefficients that are not `free` must not be
/// negative. G (`gram`) is symmetric and positive semidefinite; r is `right`. The method works on the normal
/// equations. Source: C. Lawson, R. Hanson, Solving Least Squares Problems, 1974, ch. 23.
Eigen::VectorXd solveSigned(const Eigen::MatrixXd& gram, const Eigen::VectorXd& right,
                            const std::vector<bool>& free);

/// Inner products of the columns with each other and with the target, for each cycle. Fits use only these
/// and need not read the scans again.
class CycleGrams {
 public:
  /// `columns` [scans x columns]: the last one is the target. `ranges`: first scan and end of each cycle.
  CycleGrams(const Eigen::MatrixXd& columns, const std::vector<std::pair<std::size_t, std::size_t>>& ranges,
             unsigned threads);

  std::size_t cycles() const { return grams_.size(); }
  Eigen::Index target() const { return target_; }
  const Eigen::MatrixXd& of(std::size_t cycle) const { return grams_[cycle]; }

  /// Sum over the cycles whose `wanted` is true.
  Eigen::MatrixXd sum(const std::vector<bool>& wanted) const;

 private:
  Eigen::Index target_ = 0;
  std::vector<Eigen::MatrixXd> grams_;
};

/// Columns that are fitted together, and the properties of each.
struct ColumnSet {
  std::vector<Eigen::Index> columns;
  std::vector<bool> free;       ///< the coefficient may have either sign
  std::vector<bool> bent_only;  ///< the column acts only where the surface is bent
};
ColumnSet together(const ColumnSet& a, const ColumnSet& b);

/// The set's part of a Gram matrix, with the target last. `flat`: the Gram matrix is of cycles on a flat
/// surface, and columns that act only on bent surfaces are set to 0.
Eigen::MatrixXd partOf(const Eigen::MatrixXd& gram, const ColumnSet& set, bool flat);

/// Fits the coefficients of the set to its part of the summed Gram matrices.
Eigen::VectorXd fitColumns(const Eigen::MatrixXd& part, const ColumnSet& set);

/// Squared error with these coefficients.
double squaredError(const Eigen::MatrixXd& part, const Eigen::VectorXd& coefficients);

}  // namespace fsr::discrepancy
