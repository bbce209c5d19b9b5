#pragma once

#include <vector>

#include "regression/code_statistics.h"
#include "regression/forest/forest.h"
#include "regression/grnn/grnn.h"
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

// Regressors of a reading and a second input, which has one value for each class. Each returns the answers at
// the inputs of every class [classes]. At least one class must have readings, and the scales of the inputs
// must belong to the readings given.

/// The kernel mean of each class, with the standard deviation of all readings and with all logarithms of the
/// weight: what a calibration stores to blend kernels. Every class must have a reading.
std::vector<KernelMean> classKernels(const ClassReadings& readings, const GrnnOptions& options);

std::vector<Fit> fitGrnnOnInput(const ClassReadings& readings, const ClassInputs& inputs,
                                const GrnnOptions& options);

/// Least squares on reading and columns; the solution of least norm where columns are linearly dependent.
std::vector<Fit> fitLinearOnInput(const ClassReadings& readings, const ClassInputs& inputs);

/// The inputs must have one column.
std::vector<Fit> fitForestOnInput(const ClassReadings& readings, const ClassInputs& inputs,
                                  const ForestOptions& options);

}  // namespace fsr::regression
