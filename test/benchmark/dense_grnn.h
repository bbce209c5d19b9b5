#pragma once

#include <vector>

#include "regression/code_statistics.h"

namespace benchmark_data {

/// Reference for comparison: the GRNN's formula in float64 with Eigen's vectorised exp; the smallest distance
/// is subtracted from the exponents. Compiled for the computer on which it runs.
std::vector<double> denseGrnn(const fsr::regression::CodeSamples& train,
                              const fsr::regression::CodeSamples& test, double bandwidth);

}  // namespace benchmark_data
