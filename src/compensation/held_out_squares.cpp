#include "compensation/held_out_squares.h"

namespace fsr::compensation {

double squaredErrors(const regression::CodeStatistics& readings, const std::vector<double>& pressure) {
  double squares = 0;
  readings.forEach([&](const regression::CodeSums& sums) {
    const double count = sums.count;
    const double mean = regression::fromFixed(sums.sum) / count;
    const regression::Int128 spread =
        sums.sum_of_squares * sums.count - regression::Int128{sums.sum} * sums.sum;
    const double error = pressure[sums.code] - mean;
    squares +=
        static_cast<double>(spread) / count * regression::kFixedPressureUnit * regression::kFixedPressureUnit;
    squares += count * error * error;
  });
  return squares;
}

std::vector<double> sumOverTaxels(const std::vector<std::vector<double>>& of_taxel) {
  std::vector<double> sums(of_taxel.front().size(), 0.0);
  for (const std::vector<double>& values : of_taxel) {
    for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += values[i];
  }
  return sums;
}

}  // namespace fsr::compensation
