#pragma once

#include <vector>

#include "fsr_pressure_map/regression/code_samples.h"

namespace benchmark_data {

/// The peer: the GRNN as its formula stands, in float64 with Eigen's vectorised exp, the smallest distance
/// taken out of the exponents. Compiled for this very machine.
std::vector<double> denseGrnn(const fsr::regression::CodeSamples& train,
                              const fsr::regression::CodeSamples& test, double bandwidth);

}  // namespace benchmark_data
