#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "fsr_pressure_map/regression/regressor_options.h"
#include "regression/regressor.h"

namespace fsr::regression {

/// Random forest of regression trees (Breiman 2001), computed exactly. Each tree grows on N readings drawn
/// with replacement from the N readings of training. A node is cut where the sum of squared errors decreases
/// most, midway between two neighbouring codes, if both sides keep at least `minimum_leaf`. Codes below the
/// cut go left and codes at it go right, as in MATLAB. Nodes are cut until no cut is possible. The answer is
/// the mean over trees of the mean pressure of the leaf. MATLAB's tolerance on a node's error (1e-6 of the
/// variance) is not applied; it would leave out cuts that change nothing visible.
///
/// "One third of the inputs" of one input is that input. The forest of a single reading is therefore bagging:
/// a node is an interval of codes, its sums are differences of prefix sums, and all trees together are one
/// step function, the table.
///
/// Each tree has its own random stream, derived from the seed, and draws from readings that are sorted by
/// their values. Neither the number of threads nor the order of the bags has an effect. The probability of
/// drawing a reading is right to N 2^-32 of itself.
///
/// `support` is the mean number of drawn readings in the leaves that answer.
///
/// Not mergeable, because it draws single readings.
class Forest : public Regressor {
 public:
  /// Throws InputError if trees are not 1 to 100,000, or minimum_leaf is 0.
  explicit Forest(const ForestOptions& options = {});

  std::string name() const override { return "forest"; }
  bool mergeable() const override { return false; }
  Fit fit(const CodeHistogram& training) const override;
  /// The curvature of the samples is not used.
  Fit fitSamples(const CodeSamples& training) const override;

 private:
  ForestOptions options_;
};

/// A forest on reading and curvature as tables: one for each interval between the curvatures at which any
/// tree splits.
struct CurvatureSteps {
  std::vector<double> split;  ///< ascending [1/m]
  std::vector<Fit> fits;      ///< one more than splits; fits[i] answers from split[i - 1] to below split[i]

  const Fit& at(double curvature) const;
};

/// Largest number of curvatures in training: the number of tables grows with its square.
constexpr std::size_t kMostForestCurvatures = 32;

/// The forest on two inputs. At each node one of them, drawn at random with equal probability ("one third of
/// the inputs"), is searched for a cut. Throws InputError as Forest does, and if samples have no curvature or
/// more than kMostForestCurvatures different ones.
CurvatureSteps fitCurvatureForest(const CodeSamples& training, const ForestOptions& options = {});

}  // namespace fsr::regression
