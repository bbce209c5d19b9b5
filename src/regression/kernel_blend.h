#pragma once

#include <vector>

#include "regression/grnn/kernel_mean.h"
#include "regression/regressor.h"

namespace fsr::regression {

/// A GRNN of two inputs is, at one value of the second, the mean of one-input GRNNs, one for each value
/// that training held:
///
///     f(c) = sum_k e^-x_k w_k(c) f_k(c) / sum_k e^-x_k w_k(c),
///
/// w_k being the kernel sum of class k at code c and x_k = D_k^2 / 2 sigma^2 the exponent of the class's
/// distance. `classes` [K] with log_weight (kWhereZero will do), `exponent` [K] >= 0. Where everything
/// underflows the logarithms decide, so that the nearest sample answers, as in gaussianMean().
Fit blendKernels(const std::vector<KernelMean>& classes, const std::vector<double>& exponent);

}  // namespace fsr::regression
