#pragma once

#include "regression/regressor.h"

namespace fsr::regression {

/// Ordinary least squares of pressure on the reading, the paper's simplest model:
///
///     f(c) = mean P + b (c - mean c),   b = sum (c_i - mean c) P_i / sum (c_i - mean c)^2.
///
/// The line goes on beyond the codes of training, below zero pressure too: clipping it would hide that
/// a sensor's curve is not straight. Sums of each code suffice, so it merges exactly.
///
/// Readings that never differ leave no slope to find: the answer is their mean pressure everywhere.
///
/// `support` is 1 / leverage: the number of samples whose mean would have the variance that the line has
/// at that code, N at the mean reading and less towards either side.
class LinearRegression : public Regressor {
 public:
  std::string name() const override { return "linear"; }
  Fit fit(const CodeHistogram& training) const override;
};

}  // namespace fsr::regression
