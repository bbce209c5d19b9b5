#include "compensation/fit_scheme.h"

#include <gtest/gtest.h>

#include <cmath>

#include "fsr_pressure_map/settings/input_error.h"
#include "regression/forest/forest.h"
#include "regression/grnn/grnn.h"
#include "regression/grnn/weighted_codes.h"
#include "support/holds.h"

namespace fsr::compensation {
namespace {

constexpr std::uint16_t kFullScale = 1023;
const std::vector<dataset::CurvatureClass> kThreeClasses = {
    {"flat", {0.0}}, {"radius_10cm", {10.0}}, {"radius_5cm", {20.0}}};

// Readings that numpy can reproduce:
//
//   n = [60, 80, 100]; k = [0., 10., 20.]; q = np.repeat([0, 1, 2], n)
//   i = np.concatenate([np.arange(m) for m in n])
//   c = np.concatenate([(37*np.arange(m)**2 + 11*np.arange(m)*(j + 1)) % 900 + 100 for j, m in enumerate(n)])
//   P = 400*c*(1 - 0.01*np.array(k)[q]) + 2000*np.array(k)[q] + (7919*i) % 1000
regression::CodeSamples samplesOf(std::size_t curvature_class, int keep_each = 1) {
  regression::CodeSamples samples;
  samples.full_scale = kFullScale;
  const int number = 60 + 20 * static_cast<int>(curvature_class);
  for (int i = 0; i < number; i += keep_each) {
    const int code = (37 * i * i + 11 * i * (static_cast<int>(curvature_class) + 1)) % 900 + 100;
    const double curvature = kThreeClasses[curvature_class].curvature[0];
    samples.add(static_cast<std::uint16_t>(code), regression::toFixed(400.0 * code * (1 - 0.01 * curvature) +
                                                                      2000 * curvature + (7919 * i) % 1000));
  }
  return samples;
}

regression::ClassReadings threeClasses(int keep_each = 1) {
  regression::ClassReadings readings;
  readings.full_scale = kFullScale;
  for (std::size_t k = 0; k < kThreeClasses.size(); ++k) {
    readings.samples.push_back(samplesOf(k, keep_each));
    readings.sums.emplace_back(kFullScale);
    readings.sums.back().add(regression::statisticsOf(readings.samples.back()));
  }
  return readings;
}

regression::RegressorOptions grnn(double bandwidth) {
  regression::RegressorOptions options;
  options.grnn.bandwidth = bandwidth;
  return options;
}

double answer(Scheme scheme, const regression::RegressorOptions& regressor, std::size_t code,
              std::size_t on_class) {
  const SchemePlan plan = planScheme(scheme, kThreeClasses);
  return fitScheme(plan, 0, threeClasses(), regressor)[plan.model_of_class[on_class]].pressure[code];
}

struct Expected {
  Scheme scheme;
  double bandwidth;
  std::vector<double> pressure;  // at code 0 on class 1, 333 on 0, 500 on 1, 700 on 2, 1023 on 0 [Pa]
};

TEST(FitScheme, AGrnnOfTwoInputsAgreesWithNumpy) {
  // /usr/bin/python3, numpy 1.24.2; X = np.column_stack([c, column]), column = np.array(k)[q], np.eye(3)[q]
  // or (q > 0)*1.0; m, d = X.mean(0), X.std(0, ddof=1); x = [code, column of the class], s = bandwidth:
  //   d2 = (((x - m)/d - (X - m)/d)**2).sum(1); w = np.exp(-(d2 - d2.min())/(2*s*s)); (w*P).sum()/w.sum()
  const std::vector<Expected> expected = {
      {Scheme::kCurvatureInput,
       1.0 / 128,
       {56475.0, 136571.5, 200394.67761679387, 262407.9379618851, 390456.0}},
      {Scheme::kCurvatureInput,
       0.5,
       {84241.00139003094, 127206.50052247503, 194049.47414809882, 258696.6492033118, 353833.6955055181}},
      {Scheme::kOneHot, 1.0 / 128, {56475.0, 136571.5, 200394.67761679387, 262407.9379618851, 390456.0}},
      {Scheme::kOneHot,
       0.5,
       {85380.81486710091, 126120.25160974865, 193268.57183308474, 258359.86046460763, 354437.5483871716}},
      {Scheme::kBinaryInput,
       1.0 / 128,
       {64468.75, 136571.5, 200369.04158755663, 272205.82963122136, 390456.0}},
      {Scheme::kBinaryInput,
       0.5,
       {89445.92285920787, 126121.91319357863, 199894.12397841393, 263117.5472870547, 354435.82675690524}}};
  const std::vector<std::size_t> code = {0, 333, 500, 700, 1023}, on_class = {1, 0, 1, 2, 0};
  for (const Expected& e : expected) {
    for (std::size_t i = 0; i < code.size(); ++i) {
      EXPECT_NEAR(answer(e.scheme, grnn(e.bandwidth), code[i], on_class[i]) / e.pressure[i], 1.0, 1e-12)
          << schemeName(e.scheme) << ", bandwidth " << e.bandwidth << ", code " << code[i];
    }
  }
}

TEST(FitScheme, LeastSquaresOnTwoInputsAgreeWithNumpy) {
  // the same readings; A = np.column_stack([np.ones(240), X]); b = np.linalg.lstsq(A, P, rcond=None)[0]
  regression::RegressorOptions linear;
  linear.name = "linear";
  const std::vector<Expected> expected = {
      {Scheme::kCurvatureInput, 0, {21789.393973239377, 140281.23605966775, 384892.64516532584}},
      {Scheme::kOneHot, 0, {23178.223426948847, 139441.27980163644, 384291.49341955327}},
      {Scheme::kBinaryInput, 0, {22110.939071459325, 139455.74484447783, 385140.426205373}}};
  const std::vector<std::size_t> code = {0, 333, 1023}, on_class = {1, 0, 2};
  for (const Expected& e : expected) {
    for (std::size_t i = 0; i < code.size(); ++i) {
      EXPECT_NEAR(answer(e.scheme, linear, code[i], on_class[i]) / e.pressure[i], 1.0, 1e-11)
          << schemeName(e.scheme) << ", code " << code[i];
    }
  }
}

// Method 2 of the paper cannot use the curvature at the paper's bandwidth: the standardised curvatures are so
// many bandwidths apart that readings of other classes have no weight.
TEST(FitScheme, CurvatureInputIsPerCurvatureAtThePapersBandwidth) {
  const regression::ClassReadings readings = threeClasses();
  regression::CodeHistogram all(kFullScale);
  for (const regression::CodeHistogram& sums : readings.sums) all.add(sums);
  for (const Scheme scheme : {Scheme::kCurvatureInput, Scheme::kOneHot}) {
    const std::vector<regression::Fit> with_input =
        fitScheme(planScheme(scheme, kThreeClasses), 0, readings, grnn(regression::kPaperBandwidth));
    for (std::size_t k = 0; k < kThreeClasses.size(); ++k) {
      // the model of the class, with the bandwidth in units of all readings
      const double unit = regression::readingDeviation(all) / regression::readingDeviation(readings.sums[k]);
      const regression::Fit alone =
          regression::Grnn(regression::kPaperBandwidth * unit).fit(readings.sums[k]);
      for (std::size_t code = 0; code <= kFullScale; ++code) {
        EXPECT_NEAR(with_input[k].pressure[code] / alone.pressure[code], 1.0, 1e-12);
      }
    }
  }
}

TEST(FitScheme, BinaryInputIsFlatOrCurvedAtThePapersBandwidth) {
  const regression::ClassReadings readings = threeClasses();
  regression::CodeHistogram all(kFullScale), bent(kFullScale);
  for (const regression::CodeHistogram& sums : readings.sums) all.add(sums);
  for (const std::size_t k : {1, 2}) bent.add(readings.sums[k]);
  const double unit = regression::readingDeviation(all) / regression::readingDeviation(bent);
  const auto two = fitScheme(planScheme(Scheme::kFlatOrCurved, kThreeClasses), 0, readings,
                             grnn(regression::kPaperBandwidth * unit));
  const auto input = fitScheme(planScheme(Scheme::kBinaryInput, kThreeClasses), 0, readings,
                               grnn(regression::kPaperBandwidth));
  for (std::size_t code = 0; code <= kFullScale; ++code) {
    EXPECT_NEAR(input[1].pressure[code] / two[1].pressure[code], 1.0, 1e-12);
  }
}

TEST(FitScheme, AForestDoesNotDependOnTheUnitOfCurvature) {
  regression::RegressorOptions forest;
  forest.name = "forest";
  forest.forest.trees = 20;
  const regression::ClassReadings readings = threeClasses();
  const auto fits = fitScheme(planScheme(Scheme::kCurvatureInput, kThreeClasses), 0, readings, forest);
  regression::CodeSamples all;
  all.full_scale = kFullScale;
  for (std::size_t k = 0; k < kThreeClasses.size(); ++k) {
    regression::CodeSamples samples = readings.samples[k];
    samples.curvature.assign(samples.size(), kThreeClasses[k].curvature[0]);
    all.append(samples);
  }
  const regression::CurvatureSteps steps = regression::fitCurvatureForest(all, forest.forest);
  for (std::size_t k = 0; k < kThreeClasses.size(); ++k) {
    EXPECT_EQ(fits[k].pressure, steps.at(kThreeClasses[k].curvature[0]).pressure);
  }
}

TEST(FitScheme, AClassWithoutReadingsIsPredictedFromItsNeighboursWithCurvatureAsInput) {
  regression::ClassReadings readings = threeClasses();
  readings.sums[1] = regression::CodeHistogram(kFullScale);
  readings.samples.clear();
  const auto input = fitScheme(planScheme(Scheme::kCurvatureInput, kThreeClasses), 0, readings, grnn(1.0));
  const auto alone = fitScheme(planScheme(Scheme::kPerCurvature, kThreeClasses), 0, readings, grnn(1.0));
  EXPECT_TRUE(alone[1].pressure.empty());
  EXPECT_GT(input[1].pressure[500], input[0].pressure[500]);
  EXPECT_LT(input[1].pressure[500], input[2].pressure[500]);
  readings.sums[0] = readings.sums[2] = regression::CodeHistogram(kFullScale);
  for (const regression::Fit& fit :
       fitScheme(planScheme(Scheme::kCurvatureInput, kThreeClasses), 0, readings, grnn(1.0))) {
    EXPECT_TRUE(fit.pressure.empty());
  }
}

TEST(FitScheme, AClassWithoutReadingsIsPredictedByTheSchemesRule) {
  regression::ClassReadings readings = threeClasses();
  readings.samples.clear();
  readings.sums[1] = regression::CodeHistogram(kFullScale);
  const auto answer = [&](Scheme scheme, const EffectLaw& law = {}) {
    const SchemePlan plan = planScheme(scheme, kThreeClasses);
    return answerOn(plan, 0, readings, fitScheme(plan, 0, readings, grnn(0.1)), 1, law);
  };
  const auto alone = fitScheme(planScheme(Scheme::kPerCurvature, kThreeClasses), 0, readings, grnn(0.1));
  const std::vector<double>&flat = alone[0].pressure, &bent = alone[2].pressure;
  EXPECT_EQ(answer(Scheme::kPerCurvature), flat);  // midway: the first of two equally near classes
  EXPECT_EQ(answer(Scheme::kFlatOrCurved), flat);
  EXPECT_NEAR(answer(Scheme::kInterpolated)[500], 0.5 * (flat[500] + bent[500]), 1e-6);
  EXPECT_EQ(answer(Scheme::kBaseline),
            fitScheme(planScheme(Scheme::kBaseline, kThreeClasses), 0, readings, grnn(0.1))[0].pressure);
  const EffectLaw law{{0, 10, 20}, {1.0, 0.8, 0.8}, {0, 0, 0}};  // the full effect from 10 1/m on
  EXPECT_NEAR(answer(Scheme::kCurvatureMap, law)[500], 0.8 / 0.9 * 0.5 * (flat[500] + bent[500]), 1e-6);
}

TEST(FitScheme, ASingleClassIsFittedWithoutItsCurvature) {
  regression::ClassReadings readings = threeClasses();
  readings.sums.erase(readings.sums.begin() + 1, readings.sums.end());
  readings.samples.clear();
  const auto input =
      fitScheme(planScheme(Scheme::kCurvatureInput, {kThreeClasses[0]}), 0, readings, grnn(0.1));
  const regression::Fit alone = regression::Grnn(0.1).fit(readings.sums[0]);
  for (std::size_t code = 0; code <= kFullScale; ++code) {
    EXPECT_NEAR(input[0].pressure[code] / alone.pressure[code], 1.0, 1e-12);
  }
}

TEST(FitScheme, HeldOutModelsAreTrainedOnTheOtherSections) {
  SectionedReadings readings;
  readings.full_scale = kFullScale;
  regression::ClassReadings without_first;
  without_first.full_scale = kFullScale;
  for (std::size_t k = 0; k < kThreeClasses.size(); ++k) {
    readings.sums.push_back({regression::statisticsOf(samplesOf(k)),
                             regression::statisticsOf(samplesOf(k, 2)),
                             regression::statisticsOf(samplesOf(k, 3))});
    without_first.sums.emplace_back(kFullScale);
    for (const std::size_t s : {1, 2}) without_first.sums.back().add(readings.sums[k][s]);
  }
  for (const Scheme scheme : {Scheme::kBaseline, Scheme::kCurvatureInput, Scheme::kFlatOrCurved}) {
    const SchemePlan plan = planScheme(scheme, kThreeClasses);
    const auto models = crossValidateScheme(plan, 0, readings, grnn(0.1), regression::HeldOutDeviation::kYes);
    const auto fits = fitScheme(plan, 0, without_first, grnn(0.1));
    ASSERT_EQ(models.size(), plan.models.size());
    for (std::size_t m = 0; m < models.size(); ++m) {
      EXPECT_EQ(models[m].held_out[0].pressure, fits[m].pressure) << schemeName(scheme);
    }
  }
}

std::string refusal(Scheme scheme, const regression::RegressorOptions& regressor) {
  return test_support::refusal([&] { requireSchemeFor(scheme, regressor); }, "accepted");
}

TEST(FitScheme, RefusesARegressorWithoutTheSecondInputByName) {
  regression::RegressorOptions options;
  options.name = "monotone";
  EXPECT_EQ(refusal(Scheme::kPerCurvature, options), "accepted");
  EXPECT_TRUE(test_support::holds(refusal(Scheme::kCurvatureInput, options), {"curvature_input"}));
  options.name = "forest";
  EXPECT_TRUE(test_support::holds(
      refusal(Scheme::kOneHot, options),
      {"one_hot", "scheme one_hot needs a model that takes a second input of several columns"}));
  EXPECT_TRUE(test_support::holds(refusal(Scheme::kScaledCurvature, options), {"scaled_curvature"}));
  options.name = "grnn";
  options.grnn.distance = regression::KernelDistance::kLiteral;
  EXPECT_TRUE(test_support::holds(refusal(Scheme::kBinaryInput, options),
                                  {"binary_input", "grnn", "squared distance", "equal weight"}));
}

}  // namespace
}  // namespace fsr::compensation
