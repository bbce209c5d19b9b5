#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "fsr_pressure_map/regression/regressor_options.h"
#include "regression/regressor.h"

namespace fsr::regression {

/// Random forest of regression trees (Breiman 2001), exact. Each tree grows on N readings drawn from
/// the N of training with replacement; a node is cut where the sum of squared errors falls most, midway
/// between two neighbouring codes of its readings, as long as both sides keep `minimum_leaf`; a code below
/// the cut goes left, one on it right, as in MATLAB; nodes are cut until none can be. The answer is the
/// mean over trees of the leaf's mean. MATLAB's tolerance on a node's error (1e-6 of the variance) is not
/// applied: it would spare cuts that change nothing visible.
///
/// "One third of the inputs" of one input is that input, so that the forest of a single reading is
/// bagging. Then a node is an interval of codes, its sums are differences of prefix sums, and all trees
/// together are one step function, the table.
///
/// Each tree draws from a stream of its own, derived from the seed, over readings put in an order that
/// depends on nothing but the readings: neither threads nor the order of the bags have an effect. Chances
/// of readings to be drawn are equal to N 2^-32 of themselves.
///
/// `support` is the mean number of readings drawn in the leaves that answer.
///
/// Draws of readings need the readings: not mergeable.
class Forest : public Regressor {
 public:
  /// Throws InputError where trees are not 1 to 100,000, or minimum_leaf is 0.
  explicit Forest(const ForestOptions& options = {});

  std::string name() const override { return "forest"; }
  bool mergeable() const override { return false; }
  Fit fit(const CodeHistogram& training) const override;
  /// Curvature is not looked at.
  Fit fitSamples(const CodeSamples& training) const override;

 private:
  ForestOptions options_;
};

/// A forest on reading and curvature, compiled: one table for each interval between the curvatures at
/// which any tree splits.
struct CurvatureSteps {
  std::vector<double> split;  ///< ascending [1/m]
  std::vector<Fit> fits;      ///< one more than splits; fits[i] answers from split[i - 1] to below split[i]

  const Fit& at(double curvature) const;
};

/// Most curvatures that one such forest may train on: the number of tables grows with its square.
constexpr std::size_t kMostForestCurvatures = 32;

/// The forest of two inputs: at each node one of them ("one third of the inputs"), drawn evenly, is
/// searched for a cut. Throws InputError as Forest does, where samples have no curvature, or more than
/// kMostForestCurvatures different ones.
CurvatureSteps fitCurvatureForest(const CodeSamples& training, const ForestOptions& options = {});

}  // namespace fsr::regression
