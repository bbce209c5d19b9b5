#include "regression/grnn/kernel_mean.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <random>
#include <utility>

#include "regression/grnn/gaussian_sums.h"
#include "regression/readings.h"

namespace fsr::regression {
namespace {

constexpr double kTolerance = 1e-12;  // of the pressure range

struct Sample {
  int code;
  double pressure;  // [Pa]
};

WeightedCodes codesOf(const std::vector<Sample>& samples) {
  CodeAccumulator accumulator(kFullScale);
  for (const Sample& s : samples) accumulator.add(static_cast<std::uint16_t>(s.code), toFixed(s.pressure));
  CodeHistogram histogram(kFullScale);
  histogram.add(accumulator.take());
  return weightedCodes(histogram);
}

// A chamber that is vented most of the time, sweeps up to 600 kPa, and dwells there.
std::vector<Sample> dwells(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::vector<Sample> samples;
  for (int i = 0; i < 2000; ++i) samples.push_back({45 + static_cast<int>(5 * uniform(random)), 0.0});
  for (int i = 0; i < 300; ++i) samples.push_back({3200 + static_cast<int>(9 * uniform(random)), 600e3});
  for (int i = 0; i < 150; ++i) {
    const double share = uniform(random);
    samples.push_back({45 + static_cast<int>(3100 * share), 600e3 * share * share});
  }
  for (Sample& s : samples) s.pressure = fromFixed(toFixed(s.pressure + 5e3 * uniform(random)));
  return samples;
}

// The formula in long double, with the smallest exponent subtracted.
struct Dense {
  std::vector<long double> pressure, log_weight;
};

Dense dense(const std::vector<Sample>& samples, const std::function<long double(long double)>& exponent) {
  std::map<int, std::pair<int, long double>> by_code;  // number and summed pressure
  for (const Sample& s : samples) {
    ++by_code[s.code].first;
    by_code[s.code].second += s.pressure;
  }
  Dense answers;
  for (int code = 0; code <= kFullScale; ++code) {
    long double least = INFINITY, sum = 0, weight = 0;
    for (const auto& [at, sums] : by_code) least = std::min(least, exponent(std::abs(at - code)));
    for (const auto& [at, sums] : by_code) {
      const long double excess = exponent(std::abs(at - code)) - least;
      if (excess > 100) continue;  // 1e-43 of the weight of the nearest
      const long double value = std::exp(-excess);
      sum += value * sums.second;
      weight += value * sums.first;
    }
    answers.pressure.push_back(sum / weight);
    answers.log_weight.push_back(std::log(weight) - least);
  }
  return answers;
}

void expectAgreement(const KernelMean& mean, const Dense& expected, double range, double width) {
  for (std::size_t code = 0; code <= kFullScale; ++code) {
    const auto pressure = static_cast<double>(expected.pressure[code]);
    ASSERT_NEAR(mean.pressure[code], pressure, kTolerance * range) << code << ", " << width;
    // an error of 1e-10 in the logarithm is a relative error of 1e-10 in the weight
    const auto log_weight = static_cast<double>(expected.log_weight[code]);
    ASSERT_NEAR(mean.log_weight[code], log_weight, 1e-10 + 1e-15 * std::abs(log_weight)) << code;
    if (log_weight > -590) {
      ASSERT_NEAR(mean.weight[code] / std::exp(log_weight), 1.0, 1e-10) << code << ", " << width;
    } else {
      ASSERT_LT(mean.weight[code], 1e-250) << code << ", " << width;
    }
  }
}

TEST(GaussianMean, AgreesWithTheDenseFormulaNearLongDwells) {
  const auto samples = dwells(1);
  for (const double sigma : {0.3, 7.0, 20.0, 28.0, 57.0, 130.0, 450.0, 30000.0}) {
    const Dense expected = dense(samples, [&](long double d) { return d * d / (2 * sigma * sigma); });
    expectAgreement(gaussianMean(codesOf(samples), sigma, LogWeight::kYes), expected, 605e3, sigma);
  }
}

TEST(GaussianMean, AgreesWithTheDenseFormulaAcrossWideGaps) {
  std::vector<Sample> samples = {{5, 1e3}, {6, 2e3}, {2500, 300e3}, {2503, 301e3}, {4095, 600e3}};
  for (int i = 0; i < 40; ++i) samples.push_back({2000 + i, 200e3 + 100.0 * i});
  for (const double sigma : {1.0, 25.0, 60.0, 200.0}) {
    const Dense expected = dense(samples, [&](long double d) { return d * d / (2 * sigma * sigma); });
    expectAgreement(gaussianMean(codesOf(samples), sigma, LogWeight::kYes), expected, 600e3, sigma);
  }
}

TEST(LaplaceMean, AgreesWithTheDenseFormula) {
  for (const auto& samples : {dwells(2), std::vector<Sample>{{5, 1e3}, {6, 2e3}, {3000, 9e3}}}) {
    for (const double length : {0.05, 3.0, 900.0}) {
      const Dense expected = dense(samples, [&](long double d) { return d / length; });
      expectAgreement(laplaceMean(codesOf(samples), length, LogWeight::kYes), expected, 605e3, length);
    }
  }
}

TEST(GaussianMean, GivesNoLogarithmsUnlessAskedFor) {
  EXPECT_TRUE(gaussianMean(codesOf(dwells(3)), 7.0).log_weight.empty());
  EXPECT_TRUE(laplaceMean(codesOf(dwells(3)), 7.0).log_weight.empty());
}

TEST(CoarseGrid, IsUsedForWideKernels) {
  EXPECT_FALSE(CoarseGrid::suits(7.0));
  EXPECT_TRUE(CoarseGrid::suits(20.0));
}

}  // namespace
}  // namespace fsr::regression
