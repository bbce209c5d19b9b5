#include "benchmark/dense_grnn.h"

#include <Eigen/Dense>

namespace benchmark_data {

namespace {

template <typename Value>
Eigen::ArrayXd toArray(const std::vector<Value>& values, double unit) {
  Eigen::ArrayXd array(static_cast<Eigen::Index>(values.size()));
  for (std::size_t i = 0; i < values.size(); ++i) {
    array[static_cast<Eigen::Index>(i)] = static_cast<double>(values[i]) * unit;
  }
  return array;
}

}  // namespace

std::vector<double> denseGrnn(const fsr::regression::CodeSamples& train,
                              const fsr::regression::CodeSamples& test, double bandwidth) {
  const Eigen::ArrayXd code = toArray(train.code, 1.0);
  const Eigen::ArrayXd pressure = toArray(train.pressure, fsr::regression::kFixedPressureUnit);
  const double variance = (code - code.mean()).square().sum() / static_cast<double>(code.size() - 1);
  const double precision = 0.5 / (bandwidth * bandwidth * variance);
  Eigen::ArrayXd exponents(code.size());
  std::vector<double> answers;
  for (const std::uint16_t query : test.code) {
    exponents = precision * (code - static_cast<double>(query)).square();
    exponents = (exponents.minCoeff() - exponents).exp();
    answers.push_back((exponents * pressure).sum() / exponents.sum());
  }
  return answers;
}

}  // namespace benchmark_data
