#pragma once

#include <string>
#include <vector>

#include "discrepancy/fit/least_squares.h"
#include "discrepancy/samples/measured.h"

namespace fsr::discrepancy {

/// One competing explanation: an effect, or generic terms of some covariates. The best of its alternatives
/// (forms, memory carried over or not) counts.
struct Family {
  std::string id;
  std::vector<ColumnSet> alternatives;
  bool generic = false;
};

/// How well an explanation fits cycles that it was not fitted to.
struct Score {
  std::vector<std::string> ids;
  ColumnSet set;                         ///< the alternative that counts
  std::vector<double> error;             ///< squared error of each cycle; NaN for hold-out cycles
  double total = 0;                      ///< sum of `error` without hold-out cycles
  Eigen::VectorXd coefficients;          ///< fitted to all cycles except the hold-out cycles
  std::vector<Eigen::VectorXd> of_fold;  ///< likewise, each without one fold
};

/// Chooses between explanations by cross-validation over the cycles.
class CrossValidation {
 public:
  CrossValidation(const Measured& measured, const CycleGrams& grams);

  /// Squared error without any explanation.
  const Score& nothing() const { return nothing_; }
  /// Score with the family added to the explanations of `with`.
  Score score(const Score& with, const Family& family) const;
  Score score(const ColumnSet& set) const;

  /// Share of the squared error of `before` that `after` removes.
  static double share(const Score& before, const Score& after);
  /// The same in standard errors. `after` removes |d|^2 + 2 d'e, where d is what it explains in addition and
  /// e is its residual. The standard error is therefore twice that of d'e. Errors within one cycle are
  /// correlated, so d'e is summed by cycle.
  double z(const Score& before, const Score& after) const;

 private:
  const Measured& measured_;
  const CycleGrams& grams_;
  // Sums of the cycles without one fold; the last sum is of all folds. Index 0: bent surfaces, 1: flat ones.
  std::vector<Eigen::MatrixXd> sums_[2];
  std::vector<bool> flat_;  // of each cycle
  Score nothing_;
};

}  // namespace fsr::discrepancy
