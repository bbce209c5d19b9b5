#pragma once

#include <vector>

#include "regression/class_inputs.h"
#include "regression/class_readings.h"
#include "regression/forest/forest.h"
#include "regression/grnn/grnn.h"
#include "regression/grnn/kernel_mean.h"

namespace fsr::regression {

// Regressors of a reading and a second input that has one value for each class. Each gives the answers at
// the inputs of every class [classes]. At least one class has readings; the inputs' scales are those of
// the readings given.

/// The kernel mean of each class, with the deviation of all readings, and all logarithms: what a calibration
/// keeps where it blends kernels. Every class has a reading.
std::vector<KernelMean> classKernels(const ClassReadings& readings, const GrnnOptions& options);

std::vector<Fit> fitGrnnOnInput(const ClassReadings& readings, const ClassInputs& inputs,
                                const GrnnOptions& options);

/// Least squares on reading and columns, the solution of least norm where columns depend on each other.
std::vector<Fit> fitLinearOnInput(const ClassReadings& readings, const ClassInputs& inputs);

/// For inputs of one column.
std::vector<Fit> fitForestOnInput(const ClassReadings& readings, const ClassInputs& inputs,
                                  const ForestOptions& options);

}  // namespace fsr::regression
