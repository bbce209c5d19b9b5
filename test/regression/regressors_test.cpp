// Properties of every regressor, checked for each one and for each of its options.

#include "regression/regressors.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "fsr_pressure_map/settings/input_error.h"
#include "regression/cross_validation.h"
#include "support/holds.h"
#include "support/regression_data.h"

namespace fsr::regression {
namespace {

struct Variant {
  std::string title;
  RegressorOptions options;
  double rmse_percent;  // on test/data/regression.csv, by another package or from the scatter of the curve
  double tolerance;
};

std::ostream& operator<<(std::ostream& out, const Variant& variant) {
  return out << variant.title;
}

Variant variant(const std::string& title, const std::string& name, double rmse_percent, double tolerance) {
  Variant result{title, {}, rmse_percent, tolerance};
  result.options.name = name;
  return result;
}

std::vector<Variant> variants() {
  // rmse_percent: make_regression_data.py; GRNN: numpy, dense formula
  std::vector<Variant> all = {variant("linear", "linear", 6.4883855033, 1e-7),  //
                              variant("grnn", "grnn", 4.8185991615, 1e-7),
                              variant("grnn_matlab_spread", "grnn", 4.7736266963, 1e-7),
                              variant("grnn_literal", "grnn", 4.7088471812, 1e-7),
                              variant("grnn_pressure_bins", "grnn", 4.8, 0.3),
                              variant("forest", "forest", 4.9384, 0.06),
                              variant("forest_distinct", "forest", 4.8816, 0.05),
                              variant("monotone", "monotone", 4.8, 0.4)};
  all[2].options.grnn.bandwidth = 1.0 / 64;
  all[2].options.grnn.spread = SpreadMeaning::kHalf;
  all[3].options.grnn.bandwidth = 1.0 / 8;
  all[3].options.grnn.distance = KernelDistance::kLiteral;
  all[4].options.grnn.weighting = SampleWeighting::kEachPressureBin;
  all[6].options.forest.leaf_count = LeafCount::kDistinct;
  return all;
}

class EveryRegressor : public testing::TestWithParam<Variant> {
 protected:
  std::unique_ptr<Regressor> regressor_ = makeRegressor(GetParam().options);
};

CodeSamples curve(std::size_t number, unsigned seed, std::uint16_t full_scale = 4095) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  CodeSamples samples;
  samples.full_scale = full_scale;
  for (std::size_t i = 0; i < number; ++i) {
    const double share = uniform(random);
    const double reading = (0.1 + 0.7 * std::sqrt(share) + 0.02 * uniform(random)) * full_scale;
    samples.add(static_cast<std::uint16_t>(reading), toFixed(620e3 * share));
  }
  return samples;
}

void expectAnAnswerAtEveryCode(const Fit& fit, std::uint16_t full_scale) {
  ASSERT_EQ(fit.pressure.size(), full_scale + 1u);
  ASSERT_EQ(fit.support.size(), full_scale + 1u);
  for (std::size_t code = 0; code < fit.pressure.size(); ++code) {
    ASSERT_TRUE(std::isfinite(fit.pressure[code])) << code;
    ASSERT_LT(std::abs(fit.pressure[code]), 100 * kLargestPressure) << code;
    ASSERT_GE(fit.support[code], 0.0) << code;
    ASSERT_TRUE(std::isfinite(fit.support[code])) << code;
  }
}

TEST_P(EveryRegressor, HasAFiniteAnswerAtEveryCode) {
  expectAnAnswerAtEveryCode(regressor_->fitSamples(curve(700, 1)), 4095);
  expectAnAnswerAtEveryCode(regressor_->fitSamples(curve(700, 2, 65535)), 65535);
}

TEST_P(EveryRegressor, StaysWithinThePressuresOfTrainingInGaps) {
  CodeSamples samples;
  samples.full_scale = 4095;
  for (std::uint16_t i = 0; i < 40; ++i) {
    samples.add(i, toFixed(100.0 * i));
    samples.add(static_cast<std::uint16_t>(2000 + i), toFixed(300e3 + 100.0 * i));
    samples.add(static_cast<std::uint16_t>(4000 + i), toFixed(600e3 + 100.0 * i));
  }
  const Fit fit = regressor_->fitSamples(samples);
  expectAnAnswerAtEveryCode(fit, 4095);
  for (std::size_t code = 100; code < 3950; ++code) {
    ASSERT_GE(fit.pressure[code], -1e3) << code;
    ASSERT_LE(fit.pressure[code], 605e3) << code;
  }
}

TEST_P(EveryRegressor, IsRepeatableBitForBit) {
  const CodeSamples samples = curve(500, 3);
  const Fit first = regressor_->fitSamples(samples);
  const Fit again = makeRegressor(GetParam().options)->fitSamples(samples);
  EXPECT_EQ(first.pressure, again.pressure);
  EXPECT_EQ(first.support, again.support);
}

TEST_P(EveryRegressor, DoesNotDependOnTheOrderOfReadings) {
  CodeSamples samples = curve(500, 4);
  const Fit forward = regressor_->fitSamples(samples);
  std::reverse(samples.code.begin(), samples.code.end());
  std::reverse(samples.pressure.begin(), samples.pressure.end());
  EXPECT_EQ(regressor_->fitSamples(samples).pressure, forward.pressure);
}

TEST_P(EveryRegressor, MergesExactlyOrSaysThatItNeedsTheBags) {
  const CodeSamples first = curve(400, 5), second = curve(300, 6);
  CodeStatistics sums = statisticsOf(second);
  sums.merge(statisticsOf(first));
  CodeHistogram merged(4095);
  merged.add(sums);
  if (!regressor_->mergeable()) {
    EXPECT_THROW(regressor_->fit(merged), settings::InputError);
    return;
  }
  CodeSamples both = first;
  both.append(second);
  EXPECT_EQ(regressor_->fit(merged).pressure, regressor_->fitSamples(both).pressure);
  EXPECT_EQ(regressor_->fit(merged).support, regressor_->fitSamples(both).support);
}

TEST_P(EveryRegressor, OfAConstantReadingIsTheMeanPressure) {
  CodeSamples samples;
  samples.full_scale = 4095;
  for (int i = 0; i < 100; ++i) samples.add(1234, toFixed(1e3 * i));
  const Fit fit = regressor_->fitSamples(samples);
  // the mean of a hundred resampled readings scatters by 29 kPa / sqrt(100 x 150); bin edges cut some
  // readings off
  const double tolerance = regressor_->mergeable() ? 1e-6 : 1e3;
  for (const std::size_t code : {0, 1234, 4095}) EXPECT_NEAR(fit.pressure[code], 49.5e3, tolerance) << code;
}

TEST_P(EveryRegressor, OfAConstantPressureIsThatPressure) {
  CodeSamples samples;
  samples.full_scale = 4095;
  for (std::uint16_t i = 0; i < 100; ++i) samples.add(static_cast<std::uint16_t>(30 * i), toFixed(5e3));
  const Fit fit = regressor_->fitSamples(samples);
  for (const double pressure : fit.pressure) ASSERT_NEAR(pressure, 5e3, 1e-9);
}

TEST_P(EveryRegressor, OfOneReadingIsItsPressure) {
  CodeSamples samples;
  samples.full_scale = 4095;
  samples.add(77, toFixed(12e3));
  const Fit fit = regressor_->fitSamples(samples);
  for (const double pressure : fit.pressure) ASSERT_EQ(pressure, 12e3);
}

TEST_P(EveryRegressor, PredictsAsWellAsOtherPackages) {
  const auto data = test_support::regressionData();
  const Fit fit = regressor_->fitSamples(data.train);
  std::vector<double> answers;
  for (const std::uint16_t code : data.test.code) answers.push_back(fit.pressure[code]);
  EXPECT_NEAR(test_support::rmsePercentOn(data.test, answers), GetParam().rmse_percent, GetParam().tolerance);
}

INSTANTIATE_TEST_SUITE_P(Regressors, EveryRegressor, testing::ValuesIn(variants()),
                         [](const auto& instance) { return instance.param.title; });

TEST(Regressors, AreMadeByNameAndOtherNamesAreRefused) {
  for (const std::string& name : regressorNames()) {
    RegressorOptions options;
    options.name = name;
    EXPECT_EQ(makeRegressor(options)->name(), name);
  }
  RegressorOptions other;
  other.name = "perceptron";
  EXPECT_TRUE(
      test_support::holds(test_support::refusal([&] { makeRegressor(other); }), {"model is \"perceptron\""}));
}

}  // namespace
}  // namespace fsr::regression
