#pragma once

#include <vector>

#include "regression/grnn/kernel_mean.h"
#include "regression/regressor.h"

namespace fsr::regression {

/// A GRNN of two inputs is, at one value of the second input, a weighted mean of GRNNs of one input, one for
/// each value in training:
///
///     f(c) = sum_k e^-x_k w_k(c) f_k(c) / sum_k e^-x_k w_k(c).
///
/// w_k is the kernel sum of class k at code c, and x_k = D_k^2 / 2 sigma^2 the exponent for the distance of
/// the class. `classes` [K] have log_weight (kWhereZero is sufficient), `exponent` [K] >= 0. Where all
/// weights underflow, their logarithms are used, so that the nearest sample answers, as in gaussianMean().
Fit blendKernels(const std::vector<KernelMean>& classes, const std::vector<double>& exponent);

}  // namespace fsr::regression
