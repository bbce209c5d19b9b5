#pragma once

#include <string>
#include <vector>

#include "regression/code_statistics.h"

// The GRNN part of the paper's study on one taxel, for timing: five schemes, down-sampled as in the paper,
// with each section held out in turn, over a grid of bandwidths.

namespace benchmark_data {

constexpr std::size_t kSchemes = 5;
/// "baseline", "method_1" ... "method_4".
extern const std::vector<std::string> kSchemeNames;

/// RMSE% [schemes x bandwidths], means over sections (and over the models of methods 1 and 3).
/// `cells` are the taxel's readings, [conditions x sections].
std::vector<double> grnnStudy(const std::vector<fsr::regression::CodeSamples>& cells,
                              const std::vector<double>& bandwidths);

}  // namespace benchmark_data
