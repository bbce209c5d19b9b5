#pragma once

#include <vector>

#include "regression/class_inputs.h"
#include "regression/class_readings.h"
#include "regression/forest/forest.h"
#include "regression/grnn/grnn.h"
#include "regression/grnn/kernel_mean.h"

namespace fsr::regression {

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
