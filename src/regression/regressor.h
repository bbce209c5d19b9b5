#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "regression/code_samples.h"
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

}  // namespace fsr::regression
