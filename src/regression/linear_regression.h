#pragma once

#include "regression/regressor.h"

namespace fsr::regression {

/// Ordinary least squares of pressure on the reading, the paper's simplest model (Ahmadizadeh and Menon 2019,
/// doi:10.3390/s19245519):
///
///     f(c) = mean P + b (c - mean c),   b = sum (c_i - mean c) P_i / sum (c_i - mean c)^2.
///
/// The line is not limited to the codes of training nor to positive pressure: clipping it would hide that the
/// curve of a sensor is not straight. The sums of each code are sufficient, so merging is exact.
///
/// If all readings are equal, there is no slope, and the answer is their mean pressure everywhere.
///
/// `support` is 1 / leverage: the number of samples whose mean would have the variance of the line at that
/// code. It is N at the mean reading and decreases to both sides.
class LinearRegression : public Regressor {
 public:
  std::string name() const override { return "linear"; }
  Fit fit(const CodeHistogram& training) const override;
};

}  // namespace fsr::regression
