#include "regression/forest/forest.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <thread>

#include "fsr_pressure_map/settings/input_error.h"
#include "support/regression_data.h"

namespace fsr::regression {
namespace {

using test_support::regressionData;
using test_support::rmsePercentOn;

// Mean RMSE% over seeds 1 to 10. Its own scatter is 0.004, and 0.12 on two inputs with leaves.
double meanRmse(ForestOptions options, const std::function<double(const ForestOptions&)>& rmse) {
  double sum = 0;
  for (options.seed = 1; options.seed <= 10; ++options.seed) sum += rmse(options);
  return sum / 10;
}

double twoInputs(const ForestOptions& options) {
  static const auto data = regressionData();
  const CurvatureSteps steps = fitCurvatureForest(data.train, options);
  std::vector<double> answers;
  for (std::size_t i = 0; i < data.test.size(); ++i) {
    answers.push_back(steps.at(data.test.curvature[i]).pressure[data.test.code[i]]);
  }
  return rmsePercentOn(data.test, answers);
}

constexpr double kRmseTolerance = 0.05;  // [%] of the range

TEST(Forest, OnTwoInputsWithRetryAgreesWithScikitLearn) {
  ForestOptions options;
  options.leaf_count = LeafCount::kDistinct;
  EXPECT_NEAR(meanRmse(options, twoInputs), 2.4662, kRmseTolerance);
}

TEST(Forest, OnTwoInputsWithLeavesAgreesWithRanger) {
  ForestOptions options;
  options.sampling = InputSampling::kLeaf;
  EXPECT_NEAR(meanRmse(options, twoInputs), 5.7572, 0.4);
}

CodeSamples samplesOf(const std::vector<std::uint16_t>& code, const std::vector<double>& pressure) {
  CodeSamples samples;
  samples.full_scale = 4095;
  for (std::size_t i = 0; i < code.size(); ++i) samples.add(code[i], toFixed(pressure[i]));
  return samples;
}

TEST(Forest, CutsAClearStepMidway) {
  std::vector<std::uint16_t> code;
  std::vector<double> pressure;
  for (int i = 0; i < 100; ++i) {
    code.push_back(static_cast<std::uint16_t>(i < 50 ? 10 : 21));
    pressure.push_back(i < 50 ? 1e3 : 9e3);
  }
  const Fit fit = Forest().fitSamples(samplesOf(code, pressure));
  EXPECT_NEAR(fit.pressure[0], 1e3, 1e-9);
  EXPECT_NEAR(fit.pressure[15], 1e3, 1e-9);
  EXPECT_NEAR(fit.pressure[16], 9e3, 1e-9);
  EXPECT_NEAR(fit.pressure[4095], 9e3, 1e-9);
}

TEST(Forest, NoLeafIsSmallerThanTheMinimum) {
  // Four readings apart from a hundred. Among resampled readings they are often fewer than five and then not
  // cut off.
  std::vector<std::uint16_t> code(104, 10);
  std::vector<double> pressure(104, 1e3);
  std::fill(code.begin() + 100, code.end(), std::uint16_t{20});
  std::fill(pressure.begin() + 100, pressure.end(), 9e3);
  ForestOptions options;
  options.leaf_count = LeafCount::kDistinct;
  const double never_cut = Forest(options).fitSamples(samplesOf(code, pressure)).pressure[20];
  EXPECT_NEAR(never_cut, (100 * 1e3 + 4 * 9e3) / 104, 100.0);
  const double sometimes_cut = Forest().fitSamples(samplesOf(code, pressure)).pressure[20];
  EXPECT_GT(sometimes_cut, 3e3);
  EXPECT_LT(sometimes_cut, 6e3);
}

TEST(Forest, TheOrderOfReadingsHasNoEffect) {
  auto data = regressionData().train;
  const Fit forward = Forest().fitSamples(data);
  const CurvatureSteps steps = fitCurvatureForest(data);
  std::reverse(data.code.begin(), data.code.end());
  std::reverse(data.pressure.begin(), data.pressure.end());
  std::reverse(data.curvature.begin(), data.curvature.end());
  EXPECT_EQ(Forest().fitSamples(data).pressure, forward.pressure);
  const CurvatureSteps backward = fitCurvatureForest(data);
  EXPECT_EQ(backward.split, steps.split);
  for (std::size_t i = 0; i < steps.fits.size(); ++i) {
    EXPECT_EQ(backward.fits[i].pressure, steps.fits[i].pressure);
  }
}

TEST(Forest, ThreadsHaveNoEffectAndTheSeedHas) {
  const auto data = regressionData().train;
  const Forest forest;
  const Fit alone = forest.fitSamples(data);
  std::vector<Fit> fits(4);
  std::vector<std::thread> threads;
  for (Fit& fit : fits) threads.emplace_back([&] { fit = forest.fitSamples(data); });
  for (std::thread& thread : threads) thread.join();
  for (const Fit& fit : fits) EXPECT_EQ(fit.pressure, alone.pressure);
  ForestOptions other;
  other.seed = 2;
  EXPECT_NE(Forest(other).fitSamples(data).pressure, alone.pressure);
}

TEST(Forest, TablesCoverEveryCurvature) {
  const CurvatureSteps steps = fitCurvatureForest(regressionData().train);
  EXPECT_TRUE(std::is_sorted(steps.split.begin(), steps.split.end()));
  ASSERT_EQ(steps.fits.size(), steps.split.size() + 1);
  for (const Fit& fit : steps.fits) {
    for (const double pressure : fit.pressure) ASSERT_TRUE(std::isfinite(pressure));
  }
  // flat and bent are separated midway between 0 and 7.69 1/m, among other cuts
  EXPECT_TRUE(std::count(steps.split.begin(), steps.split.end(), 7.69 / 2));
  EXPECT_NE(&steps.at(3.8), &steps.at(3.9));
  EXPECT_EQ(&steps.at(-100.0), &steps.fits.front());
  EXPECT_EQ(&steps.at(100.0), &steps.fits.back());
}

TEST(Forest, OptionsAndInputOutOfRangeAreRefused) {
  ForestOptions none;
  none.trees = 0;
  EXPECT_THROW(Forest{none}, settings::InputError);
  none = {};
  none.minimum_leaf = 0;
  EXPECT_THROW(Forest{none}, settings::InputError);
  CodeSamples samples = samplesOf({1, 2}, {1e3, 2e3});
  EXPECT_THROW(fitCurvatureForest(samples), settings::InputError);  // no curvature
  samples = samplesOf(std::vector<std::uint16_t>(33, 1), std::vector<double>(33, 1e3));
  for (int i = 0; i < 33; ++i) samples.curvature.push_back(i);
  EXPECT_THROW(fitCurvatureForest(samples), settings::InputError);  // too many
  EXPECT_THROW(Forest().fit(CodeHistogram(4095)), settings::InputError);
}

}  // namespace
}  // namespace fsr::regression
