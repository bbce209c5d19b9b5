#pragma once

#include <cstddef>
#include <string>

#include "fsr_pressure_map/regression/regressor_options.h"
#include "regression/regressor.h"

namespace fsr::regression {

/// Throws InputError if the bandwidth is not within 1e-6 to 1000.
void validate(const GrnnOptions& options);

/// Sigma of the kernel in standard deviations of the training readings.
double sigmaOf(const GrnnOptions& options);

/// General regression neural network (Specht 1991), the paper's model (Ahmadizadeh and Menon 2019,
/// doi:10.3390/s19245519): the mean pressure of the training samples, weighted by a Gaussian of their
/// distance d from the reading,
///
///     f(c) = sum_i P_i exp(-d_i^2 / 2 sigma^2) / sum_i exp(-d_i^2 / 2 sigma^2).
///
/// Readings are standardised by the mean and the (sample) standard deviation of the training readings. Every
/// code has a finite answer; where all weights underflow it is the answer of the nearest sample (see
/// kernel_mean.h).
///
/// `support` is sum_i exp(-d_i^2 / 2 sigma^2), the number of samples near the code; 0 where there is none.
///
/// Mergeable, unless samples are weighted by pressure bins: the sums of a code do not say how many of its
/// samples are in which bin.
class Grnn : public Regressor {
 public:
  /// Both throw InputError as validate() does.
  explicit Grnn(double bandwidth = kPaperBandwidth);
  explicit Grnn(const GrnnOptions& options);

  std::string name() const override { return "grnn"; }
  bool mergeable() const override { return options_.weighting == SampleWeighting::kEachSample; }
  Fit fit(const CodeHistogram& training) const override;
  Fit fitSamples(const CodeSamples& training) const override;

  double bandwidth() const { return options_.bandwidth; }
  const GrnnOptions& options() const { return options_; }

 private:
  GrnnOptions options_;
};

}  // namespace fsr::regression
