#include "fsr_pressure_map/compensation/kernel_blend.h"

#include <algorithm>
#include <cmath>

namespace fsr {

namespace {

// Of a larger sum nothing that matters has underflowed: what gaussianMean() lets underflow is below
// exp(-600), what a product lets below exp(-700).
const double kSafeWeight = std::exp(-500.0);
// Weights below exp(-40) of the largest do not count.
constexpr double kNegligibleExponent = 40.0;
constexpr std::size_t kCodesInCache = 512;

double logWeight(const KernelMean& mean, std::size_t code) {
  return mean.weight[code] > 0 ? std::log(mean.weight[code]) : mean.log_weight[code];
}

// The answer at one code by logarithms. `log_weight` [K] is room for them.
double byLogarithms(const std::vector<KernelMean>& classes, const std::vector<double>& exponent,
                    std::size_t code, std::vector<double>& log_weight) {
  double largest = -INFINITY;
  for (std::size_t k = 0; k < classes.size(); ++k) {
    log_weight[k] = logWeight(classes[k], code) - exponent[k];
    largest = std::max(largest, log_weight[k]);
  }
  double sum = 0, weight = 0;
  for (std::size_t k = 0; k < classes.size(); ++k) {
    const double below = largest - log_weight[k];
    if (below > kNegligibleExponent) continue;
    const double share = std::exp(-below);
    sum += share * classes[k].pressure[code];
    weight += share;
  }
  return sum / weight;
}

// Adds one class's share at the codes begin .. end - 1.
void addClass(const KernelMean& mean, double factor, std::size_t begin, std::size_t end, Fit& sums) {
  const double* __restrict__ pressure = mean.pressure.data();
  const double* __restrict__ weight = mean.weight.data();
  double* __restrict__ sum = sums.pressure.data();
  double* __restrict__ share = sums.support.data();
  for (std::size_t code = begin; code < end; ++code) {
    const double own = factor * weight[code];
    sum[code] += own * pressure[code];
    share[code] += own;
  }
}

}  // namespace

Fit blendKernels(const std::vector<KernelMean>& classes, const std::vector<double>& exponent) {
  const std::size_t codes = classes.front().pressure.size();
  Fit fit{std::vector<double>(codes, 0.0), std::vector<double>(codes, 0.0)};
  std::vector<double> factor;
  for (const double x : exponent) factor.push_back(std::exp(-x));
  for (std::size_t begin = 0; begin < codes; begin += kCodesInCache) {
    const std::size_t end = std::min(codes, begin + kCodesInCache);
    for (std::size_t k = 0; k < classes.size(); ++k) {
      if (factor[k] > 0) addClass(classes[k], factor[k], begin, end, fit);
    }
  }
  for (std::size_t code = 0; code < codes; ++code) fit.pressure[code] /= fit.support[code];
  std::vector<double> log_weight(classes.size());
  for (std::size_t code = 0; code < codes; ++code) {
    if (!(fit.support[code] > kSafeWeight)) {
      fit.pressure[code] = byLogarithms(classes, exponent, code, log_weight);
    }
  }
  return fit;
}

}  // namespace fsr
