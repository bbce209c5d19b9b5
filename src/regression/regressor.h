#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "regression/code_statistics.h"

namespace fsr::regression {

/// The answer of a regressor of one reading at every code. One value for each code, 0 to full scale.
struct Fit {
  std::vector<double> pressure;  ///< gauge [Pa], finite
  std::vector<double> support;   ///< effective number of training samples behind the answer
};

/// A regressor from one reading to pressure.
class Regressor {
 public:
  virtual ~Regressor() = default;

  /// The id that files and options use, e.g. "grnn".
  virtual std::string name() const = 0;

  /// Whether the sums of each code are sufficient for training. If so, calibration files can be merged by
  /// addition. If not, training needs the bags, and fit() throws InputError.
  virtual bool mergeable() const { return true; }

  /// `training` has at least one sample. Thread-safe.
  virtual Fit fit(const CodeHistogram& training) const = 0;

  /// The same from single readings. `training` has at least one. Thread-safe.
  virtual Fit fitSamples(const CodeSamples& training) const;

 protected:
  /// Throws InputError. For fit() of models that are not mergeable.
  [[noreturn]] void refuseSums() const;
};

/// The second input of a model: one value, of one or more columns, for each curvature class.
struct ClassInputs {
  /// [classes][columns], not standardised: the curvature [1/m], or a one for the class among zeros (one-hot),
  /// or 0 for flat and 1 for bent.
  std::vector<std::vector<double>> columns;
  /// 1 / standard deviation of each column over the training readings; 0 for a constant column.
  std::vector<double> scale;

  /// Squared distance between two classes in standardised units.
  double squaredDistance(std::size_t a, std::size_t b) const {
    double sum = 0;
    for (std::size_t i = 0; i < scale.size(); ++i) {
      const double difference = (columns[a][i] - columns[b][i]) * scale[i];
      sum += difference * difference;
    }
    return sum;
  }
};

}  // namespace fsr::regression
