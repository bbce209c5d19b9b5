#include "fsr_pressure_map/compensation/held_out_squares.h"

namespace fsr {

double squaredErrors(const CodeStatistics& readings, const std::vector<double>& pressure) {
  double squares = 0;
  readings.forEach([&](const CodeSums& sums) {
    const double count = sums.count;
    const double mean = fromFixed(sums.sum) / count;
    const Int128 spread = sums.sum_of_squares * sums.count - Int128{sums.sum} * sums.sum;
    const double error = pressure[sums.code] - mean;
    squares += static_cast<double>(spread) / count * kFixedPressureUnit * kFixedPressureUnit;
    squares += count * error * error;
  });
  return squares;
}

}  // namespace fsr
