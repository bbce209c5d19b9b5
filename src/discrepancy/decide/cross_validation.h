#pragma once

#include <string>
#include <vector>

#include "discrepancy/fit/least_squares.h"
#include "discrepancy/samples/measured.h"

namespace fsr::discrepancy {

/// One explanation that competes: an effect, or generic terms of some covariates. Of its alternatives
/// (forms, memory carried over or not) the best one counts.
struct Family {
  std::string id;
  std::vector<ColumnSet> alternatives;
  bool generic = false;
};

/// How well an explanation does on cycles that took no part in its fit.
struct Score {
  std::vector<std::string> ids;
  ColumnSet set;                         ///< the alternative that counts
  std::vector<double> error;             ///< squared error of each cycle, NaN of the hold-out cycles
  double total = 0;                      ///< their sum
  Eigen::VectorXd coefficients;          ///< by all cycles but the hold-out cycles
  std::vector<Eigen::VectorXd> of_fold;  ///< likewise without one fold each
};

/// Chooses between explanations by cross-validation over the cycles.
class CrossValidation {
 public:
  CrossValidation(const Measured& measured, const CycleGrams& grams);

  /// Squared error without any explanation.
  const Score& nothing() const { return nothing_; }
  /// The family added to what is in already.
  Score score(const Score& with, const Family& family) const;
  Score score(const ColumnSet& set) const;

  /// Share of the squared error of `before` that `after` takes away.
  static double share(const Score& before, const Score& after);
  /// The same in standard errors. What `after` takes away is |d|^2 + 2 d'e, d: what it explains more, e: what
  /// it leaves; so its error is twice that of d'e, which hangs together within a cycle.
  double z(const Score& before, const Score& after) const;

 private:
  const Measured& measured_;
  const CycleGrams& grams_;
  // Sums of all cycles but one fold, in the end of all; where the surface is bent, and where it is flat.
  std::vector<Eigen::MatrixXd> sums_[2];
  std::vector<bool> flat_;  // of each cycle
  Score nothing_;
};

}  // namespace fsr::discrepancy
