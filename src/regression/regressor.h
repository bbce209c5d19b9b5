#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "regression/code_samples.h"
#include "regression/code_statistics.h"

namespace fsr::regression {

/// What a regressor of one reading becomes: its answer at every code. One value for each code
/// 0 .. full scale.
struct Fit {
  std::vector<double> pressure;  ///< gauge [Pa], finite
  std::vector<double> support;   ///< effective number of training samples behind the answer
};

/// A regressor from one reading to pressure.
class Regressor {
 public:
  virtual ~Regressor() = default;

  /// The readable id that files and options use, e.g. "grnn".
  virtual std::string name() const = 0;

  /// Whether the sums of each code suffice: then a calibration file can take in further bags by
  /// addition. Where not, the model needs the bags, and fit() throws InputError that says so.
  virtual bool mergeable() const { return true; }

  /// `training` holds at least one sample. Thread-safe.
  virtual Fit fit(const CodeHistogram& training) const = 0;

  /// The same from single readings. `training` holds at least one. Thread-safe.
  virtual Fit fitSamples(const CodeSamples& training) const;

 protected:
  /// For the fit() of models that are not mergeable.
  [[noreturn]] void refuseSums() const;
};

}  // namespace fsr::regression
