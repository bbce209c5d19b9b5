#pragma once

#include <cstddef>
#include <vector>

#include "fsr_pressure_map/regression/code_statistics.h"
#include "fsr_pressure_map/regression/regressor.h"

namespace fsr {

/// The codes that occur in training, ascending: what the regressors on sums compute with.
struct WeightedCodes {
  std::size_t table_size = 0;        ///< full scale + 1
  double samples = 0;                ///< sum of `count`
  std::vector<std::ptrdiff_t> code;  ///< signed, for distances
  std::vector<double> count;         ///< weight of each code: its number of samples, unless weighted
  std::vector<double> sum;           ///< of pressure, with the same weights [Pa]
};

WeightedCodes weightedCodes(const CodeHistogram& training);

/// Sample deviation of the training readings [counts], from exact integer sums; 0 where they never differ.
double readingDeviation(const CodeHistogram& training);

/// The answer where the readings never differ: their mean pressure at every code, supported by all of
/// them at the one code and by none elsewhere.
Fit constantFit(const WeightedCodes& samples);

}  // namespace fsr
