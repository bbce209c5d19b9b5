#pragma once

#include "fsr_pressure_map/regression/regressor.h"

namespace fsr {

/// Bandwidth of the paper: the spread sigma in units of the training readings' deviation.
constexpr double kPaperBandwidth = 1.0 / 128.0;

/// General regression neural network (Specht 1991): the mean pressure of the training samples,
/// weighted by a Gaussian of their distance d from the reading,
///
///     f(c) = sum_i P_i exp(-d_i^2 / 2 sigma^2) / sum_i exp(-d_i^2 / 2 sigma^2),
///
/// readings standardised by the mean and (sample) deviation of the training readings.
///
/// Where every weight underflows, the formula is 0 / 0. The smallest distance is taken out of all
/// exponents first, which changes nothing else, so that the answer there is the nearest sample's:
/// any code has a finite answer. Samples with d^2 > d_min^2 + 2 sigma^2 ln(N / 1e-14) are left out:
/// their sum cannot move the answer by more than 1e-14 of the pressure range.
///
/// `support` is sum_i exp(-d_i^2 / 2 sigma^2), not shifted: the number of samples near the code, 0
/// where there is none.
class Grnn : public Regressor {
 public:
  /// Throws InputError where `bandwidth` is not within 1e-6 to 1000.
  explicit Grnn(double bandwidth = kPaperBandwidth);

  std::string name() const override { return "grnn"; }
  Fit fit(const CodeHistogram& training) const override;

  double bandwidth() const { return bandwidth_; }

 private:
  double bandwidth_;
};

}  // namespace fsr
