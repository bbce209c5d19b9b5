#include "regression/kernel_blend.h"

#include <algorithm>
#include <cmath>

#include "regression/grnn/vector_width.h"

namespace fsr::regression {

namespace {

// In a larger sum nothing that matters has underflowed: gaussianMean() ignores values below exp(-600), and
// products underflow below exp(-700).
const double kSafeWeight = std::exp(-500.0);
// Weights below exp(-40) of the largest are ignored.
constexpr double kNegligibleExponent = 40.0;
// Upper limit for the logarithm of the number of readings of a class, each of weight 1 at most.
constexpr double kLargestLogWeight = 40.0;
constexpr std::size_t kCodesInCache = 512;

double logWeight(const KernelMean& mean, std::size_t code) {
  return mean.weight[code] > 0 ? std::log(mean.weight[code]) : mean.log_weight[code];
}

// The answer at one code, computed with logarithms. `log_weight` [K] is memory for them. `nearest` is the
// class with the smallest exponent; starting from it, most others can be skipped.
double byLogarithms(const std::vector<KernelMean>& classes, const std::vector<double>& exponent,
                    std::size_t nearest, std::size_t code, std::vector<double>& log_weight) {
  double largest = logWeight(classes[nearest], code) - exponent[nearest];
  for (std::size_t k = 0; k < classes.size(); ++k) {
    log_weight[k] = -INFINITY;
    if (kLargestLogWeight - exponent[k] < largest - kNegligibleExponent) continue;
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

// Adds the contribution of one class at `codes` codes.
FSR_EACH_VECTOR_WIDTH
void addClass(const double* __restrict__ pressure, const double* __restrict__ weight, double factor,
              std::size_t codes, double* __restrict__ sum, double* __restrict__ share) {
  for (std::size_t code = 0; code < codes; ++code) {
    const double own = factor * weight[code];
    sum[code] += own * pressure[code];
    share[code] += own;
  }
}

FSR_EACH_VECTOR_WIDTH
void divide(const double* __restrict__ share, std::size_t codes, double* __restrict__ sum) {
  for (std::size_t code = 0; code < codes; ++code) sum[code] /= share[code];
}

}  // namespace

Fit blendKernels(const std::vector<KernelMean>& classes, const std::vector<double>& exponent) {
  const std::size_t codes = classes.front().pressure.size();
  Fit fit{std::vector<double>(codes, 0.0), std::vector<double>(codes, 0.0)};
  std::vector<double> factor;
  for (const double x : exponent) factor.push_back(std::exp(-x));
  for (std::size_t begin = 0; begin < codes; begin += kCodesInCache) {
    const std::size_t number = std::min(codes - begin, kCodesInCache);
    for (std::size_t k = 0; k < classes.size(); ++k) {
      if (factor[k] == 0) continue;
      addClass(classes[k].pressure.data() + begin, classes[k].weight.data() + begin, factor[k], number,
               fit.pressure.data() + begin, fit.support.data() + begin);
    }
    divide(fit.support.data() + begin, number, fit.pressure.data() + begin);
  }
  const auto nearest =
      static_cast<std::size_t>(std::min_element(exponent.begin(), exponent.end()) - exponent.begin());
  std::vector<double> log_weight(classes.size());
  for (std::size_t code = 0; code < codes; ++code) {
    if (!(fit.support[code] > kSafeWeight)) {
      fit.pressure[code] = byLogarithms(classes, exponent, nearest, code, log_weight);
    }
  }
  return fit;
}

}  // namespace fsr::regression
