#include "statistics/shapiro_wilk.h"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <initializer_list>
#include <string>

#include "fsr_pressure_map/settings/input_error.h"
#include "statistics/samples.h"

namespace fsr::statistics {

namespace {

constexpr std::size_t kFewest = 3;
constexpr std::size_t kMost = 5000;
const char* const kShapiroWilk = "Shapiro-Wilk test";

/// Coefficients from the constant term upwards; Royston's C1 to C6 and G.
double polynomial(std::initializer_list<double> coefficients, double x) {
  double sum = 0;
  for (auto c = std::rbegin(coefficients); c != std::rend(coefficients); ++c) sum = sum * x + *c;
  return sum;
}

/// Upper half of the weights, that of the largest value first; the lower half mirrors it.
std::vector<double> upperWeights(std::size_t n) {
  if (n == 3) return {std::sqrt(0.5)};
  const boost::math::normal normal;
  std::vector<double> m(n / 2);  // expected order statistics, Blom's formula
  double square = 0;
  for (std::size_t i = 0; i < m.size(); ++i) {
    m[i] = -boost::math::quantile(normal, (static_cast<double>(i) + 0.625) / (static_cast<double>(n) + 0.25));
    square += 2 * m[i] * m[i];
  }
  // The outermost one or two weights come from polynomials. The others are scaled to the rest of the norm.
  const double x = 1 / std::sqrt(static_cast<double>(n)), norm = std::sqrt(square);
  std::vector<double> outer = {m[0] / norm +
                               polynomial({0, 0.221157, -0.147981, -2.07119, 4.434685, -2.706056}, x)};
  if (n > 5) {
    outer.push_back(m[1] / norm + polynomial({0, 0.042981, -0.293762, -1.752461, 5.682633, -3.582633}, x));
  }
  double left = 1;
  for (std::size_t i = 0; i < outer.size(); ++i) {
    square -= 2 * m[i] * m[i];
    left -= 2 * outer[i] * outer[i];
  }
  for (double& weight : m) weight *= std::sqrt(left / square);
  std::copy(outer.begin(), outer.end(), m.begin());
  return m;
}

/// 1 - W, without cancellation where W is close to 1. `sorted`: sorted values about zero.
double oneMinusW(const std::vector<double>& sorted) {
  const std::size_t n = sorted.size();
  const std::vector<double> upper = upperWeights(n);
  double weighted = 0, weights = 0;
  for (std::size_t i = 0; i < upper.size(); ++i) {
    weighted += upper[i] * (sorted[n - 1 - i] - sorted[i]);
    weights += 2 * upper[i] * upper[i];
  }
  const double total = weights * squaredDeviations(sorted), root = std::sqrt(total);
  return (root - weighted) * (root + weighted) / total;
}

double pOfThree(double w) {
  const double pi = std::acos(-1.0);
  return std::max(0.0, 6 / pi * (std::asin(std::sqrt(w)) - std::asin(std::sqrt(0.75))));
}

double pOf(double one_minus_w, std::size_t size) {
  if (size == 3) return pOfThree(1 - one_minus_w);
  const double n = static_cast<double>(size), log_n = std::log(n);
  double y = std::log(one_minus_w), mean = 0, deviation = 0;
  if (size <= 11) {
    const double gamma = polynomial({-2.273, 0.459}, n);
    if (y >= gamma) return 0;  // beyond the range of the approximation
    y = -std::log(gamma - y);
    mean = polynomial({0.544, -0.39978, 0.025054, -6.714e-4}, n);
    deviation = std::exp(polynomial({1.3822, -0.77857, 0.062767, -0.0020322}, n));
  } else {
    mean = polynomial({-1.5861, -0.31082, -0.083751, 0.0038915}, log_n);
    deviation = std::exp(polynomial({-0.4803, -0.082676, 0.0030302}, log_n));
  }
  return boost::math::cdf(boost::math::complement(boost::math::normal(mean, deviation), y));
}

/// Sorted values minus the median, divided by their range. W does not depend on either, rounding does.
std::vector<double> standardised(std::vector<double> sample) {
  std::sort(sample.begin(), sample.end());
  const double middle = sample[sample.size() / 2], range = sample.back() - sample.front();
  for (double& x : sample) x = (x - middle) / range;
  return sample;
}

}  // namespace

TestResult shapiroWilk(const std::vector<double>& sample) {
  requireSample(sample, kFewest, kShapiroWilk);
  if (sample.size() > kMost) {
    throw settings::InputError(std::string(kShapiroWilk) + ": " + std::to_string(sample.size()) +
                               " values given, but its approximation holds for at most 5000");
  }
  if (isConstant(sample))
    throw settings::InputError(std::string(kShapiroWilk) +
                               ": all values are equal; it needs values that are not all equal");

  const double one_minus_w = std::max(0.0, oneMinusW(standardised(sample)));
  TestResult result;
  result.test = "Shapiro-Wilk";
  result.symbol = "W";
  result.statistic = 1 - one_minus_w;
  result.p = pOf(one_minus_w, sample.size());
  result.n = sample.size();
  result.method = sample.size() == 3 ? PMethod::kExact : PMethod::kNormalApproximation;
  return result;
}

}  // namespace fsr::statistics
