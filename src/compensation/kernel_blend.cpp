#include "fsr_pressure_map/compensation/kernel_blend.h"

#include <algorithm>
#include <cmath>

namespace fsr {

namespace {

// Of a larger sum nothing that matters has underflowed: what gaussianMean() lets underflow is below
// exp(-600), what a product lets below exp(-700).
const double kSafeWeight = std::exp(-500.0);
// Weights below this share of the largest do not count.
constexpr double kNegligibleExponent = 40.0;

// The answer at one code by logarithms.
double byLogarithms(const std::vector<KernelMean>& classes, const std::vector<double>& exponent,
                    std::size_t code) {
  double largest = -INFINITY;
  for (std::size_t k = 0; k < classes.size(); ++k) {
    largest = std::max(largest, classes[k].log_weight[code] - exponent[k]);
  }
  double sum = 0, weight = 0;
  for (std::size_t k = 0; k < classes.size(); ++k) {
    const double below = largest - (classes[k].log_weight[code] - exponent[k]);
    if (below > kNegligibleExponent) continue;
    const double share = std::exp(-below);
    sum += share * classes[k].pressure[code];
    weight += share;
  }
  return sum / weight;
}

}  // namespace

Fit blendKernels(const std::vector<KernelMean>& classes, const std::vector<double>& exponent) {
  const std::size_t codes = classes.front().pressure.size();
  Fit fit{std::vector<double>(codes, 0.0), std::vector<double>(codes, 0.0)};
  for (std::size_t k = 0; k < classes.size(); ++k) {
    const double factor = std::exp(-exponent[k]);
    if (factor == 0.0) continue;
    const double* const pressure = classes[k].pressure.data();
    const double* const weight = classes[k].weight.data();
    for (std::size_t code = 0; code < codes; ++code) {
      const double share = factor * weight[code];
      fit.pressure[code] += share * pressure[code];
      fit.support[code] += share;
    }
  }
  for (std::size_t code = 0; code < codes; ++code) {
    fit.pressure[code] = fit.support[code] > kSafeWeight ? fit.pressure[code] / fit.support[code]
                                                         : byLogarithms(classes, exponent, code);
  }
  return fit;
}

}  // namespace fsr
