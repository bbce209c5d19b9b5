#pragma once

#include <vector>

#include "compensation/class_input.h"
#include "compensation/class_readings.h"
#include "fsr_pressure_map/regression/forest.h"
#include "fsr_pressure_map/regression/grnn.h"
#include "regression/grnn/kernel_mean.h"

namespace fsr::compensation {

// Regressors of a reading and a second input that has one value for each class. Each gives the answers at
// the inputs of every class [classes]. At least one class has readings; the inputs' scales are those of
// the readings given.

/// The kernel mean of each class, with the deviation of all readings, and all logarithms: what a calibration
/// keeps where it blends kernels. Every class has a reading.
std::vector<regression::KernelMean> classKernels(const ClassReadings& readings,
                                                 const regression::GrnnOptions& options);

std::vector<regression::Fit> fitGrnnOnInput(const ClassReadings& readings, const ClassInputs& inputs,
                                            const regression::GrnnOptions& options);

/// Least squares on reading and columns, the solution of least norm where columns depend on each other.
std::vector<regression::Fit> fitLinearOnInput(const ClassReadings& readings, const ClassInputs& inputs);

/// For inputs of one column.
std::vector<regression::Fit> fitForestOnInput(const ClassReadings& readings, const ClassInputs& inputs,
                                              const regression::ForestOptions& options);

}  // namespace fsr::compensation
