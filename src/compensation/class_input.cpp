#include "compensation/class_input.h"

#include <cmath>
#include <numeric>

namespace fsr::compensation {

namespace {

std::vector<double> columnsOf(Scheme scheme, std::size_t curvature_class,
                              const std::vector<double>& curvature, const std::vector<bool>& bent) {
  if (scheme == Scheme::kCurvatureInput || scheme == Scheme::kScaledCurvature) {
    return {curvature[curvature_class]};
  }
  if (scheme == Scheme::kBinaryInput) return {bent[curvature_class] ? 1.0 : 0.0};
  std::vector<double> one_hot(curvature.size(), 0.0);
  one_hot[curvature_class] = 1.0;
  return one_hot;
}

// 1 / sample standard deviation of a column; 0 for a constant column.
double scaleOf(const std::vector<std::vector<double>>& columns, std::size_t column,
               const std::vector<std::uint64_t>& readings) {
  double number = 0, mean = 0, squares = 0;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    number += static_cast<double>(readings[k]);
    mean += static_cast<double>(readings[k]) * columns[k][column];
  }
  mean /= number;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const double from_mean = columns[k][column] - mean;
    squares += static_cast<double>(readings[k]) * from_mean * from_mean;
  }
  const double deviation = std::sqrt(squares / (number - 1));
  constexpr double kRounding = 1e-12;  // relative difference between equal values and their mean
  return deviation > kRounding * (1.0 + std::abs(mean)) ? 1.0 / deviation : 0.0;
}

}  // namespace

regression::ClassInputs classInputs(Scheme scheme, const std::vector<double>& curvature,
                                    const std::vector<bool>& bent,
                                    const std::vector<std::uint64_t>& readings) {
  regression::ClassInputs inputs;
  for (std::size_t k = 0; k < curvature.size(); ++k) {
    inputs.columns.push_back(columnsOf(scheme, k, curvature, bent));
  }
  for (std::size_t i = 0; i < inputs.columns.front().size(); ++i) {
    inputs.scale.push_back(scaleOf(inputs.columns, i, readings));
  }
  return inputs;
}

}  // namespace fsr::compensation
