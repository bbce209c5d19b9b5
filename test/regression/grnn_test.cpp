#include "regression/grnn/grnn.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "fsr_pressure_map/settings/input_error.h"
#include "regression/readings.h"

namespace fsr::regression {
namespace {

CodeHistogram histogramOf(const std::vector<Reading>& readings, std::uint16_t full_scale) {
  CodeHistogram histogram(full_scale);
  histogram.add(statisticsOf(readings, full_scale));
  return histogram;
}

TEST(Grnn, GapsAndFarCodesHaveTheValueOfTheNearestSample) {
  // At a distance of a hundred sigmas and more only the outermost code has weight.
  const Fit fit = Grnn(kPaperBandwidth).fit(histogramOf({{100, 1e3}, {104, 2e3}, {900, 9e3}}, 4095));
  EXPECT_NEAR(fit.pressure[0], 1e3, 1e-9);
  EXPECT_NEAR(fit.pressure[480], 2e3, 1e-9);
  EXPECT_NEAR(fit.pressure[502], 5.5e3, 1e-9);  // midway: equal weights of both neighbours
  EXPECT_NEAR(fit.pressure[4095], 9e3, 1e-9);
  EXPECT_EQ(fit.support[4095], 0.0);
}

TEST(Grnn, AgreesWithScipy) {
  // /usr/bin/python3, scipy 1.10.1: c = np.array([100.,104.,104.,110.,150.]);
  // P = np.array([1e3,2e3,3e3,5e3,20e3]); s = 20/128 * c.std(ddof=1); w = -(q-c)**2/(2*s*s)
  // np.exp(logsumexp(w, b=P) - logsumexp(w)), np.exp(w).sum()
  const Fit fit =
      Grnn(20.0 / 128).fit(histogramOf({{100, 1e3}, {104, 2e3}, {104, 3e3}, {110, 5e3}, {150, 20e3}}, 4095));
  EXPECT_NEAR(fit.pressure[0], 1000.0000000000283, 1e-9);
  EXPECT_NEAR(fit.pressure[100], 1735.9858808227318, 1e-9);
  EXPECT_NEAR(fit.pressure[105], 2620.094818665162, 1e-9);
  EXPECT_NEAR(fit.pressure[130], 12499.982287954683, 1e-8);
  EXPECT_NEAR(fit.pressure[131], 19684.0082015274, 1e-8);
  EXPECT_NEAR(fit.support[100], 1.936344787602955, 1e-14);
  EXPECT_NEAR(fit.support[127] / 9.492093537113723e-07, 1.0, 1e-12);
}

const std::vector<Reading> kFive = {{100, 1e3}, {104, 2e3}, {104, 3e3}, {110, 5e3}, {150, 20e3}};

TEST(Grnn, MatlabsSpreadIsTheDistanceOfHalfAResponse) {
  // scipy 1.10.1, c and P as above, d = np.abs(q-c)/c.std(ddof=1); w = np.log(.5)*(d/.25)**2
  // np.exp(logsumexp(w, b=P, axis=1) - logsumexp(w, axis=1))
  GrnnOptions options;
  options.bandwidth = 0.25;
  options.spread = SpreadMeaning::kHalf;
  const Fit fit = Grnn(options).fit(histogramOf(kFive, 4095));
  EXPECT_NEAR(fit.pressure[0], 1000.000001855568, 1e-9);
  EXPECT_NEAR(fit.pressure[105], 2674.477297171319, 1e-9);
  EXPECT_NEAR(fit.pressure[127], 5019.411864608382, 1e-9);
  EXPECT_NEAR(fit.pressure[131], 18330.389187408477, 1e-8);
}

TEST(Grnn, TheLiteralDistanceIsNotSquared) {
  // as above, with w = -d / (2 * .25**2)
  GrnnOptions options;
  options.bandwidth = 0.25;
  options.distance = KernelDistance::kLiteral;
  const Fit fit = Grnn(options).fit(histogramOf(kFive, 4095));
  EXPECT_NEAR(fit.pressure[0], 1498.4591242097235, 1e-9);
  EXPECT_NEAR(fit.pressure[105], 2587.6191759327426, 1e-9);
  EXPECT_NEAR(fit.pressure[127], 5681.670636268071, 1e-9);
  EXPECT_NEAR(fit.pressure[131], 14441.107703339201, 1e-8);
  EXPECT_NEAR(fit.support[105], 1.64636449, 1e-8);
}

TEST(Grnn, WithEqualPressureBinsTheDurationOfAPressureHasNoEffect) {
  // Two pressures with overlapping readings: held equally long, and one of them nine times as long.
  const auto train = [](int times_high, SampleWeighting weighting) {
    CodeSamples samples;
    samples.full_scale = 4095;
    for (std::uint16_t code = 1000; code < 1100; ++code) {
      samples.add(code, toFixed(100e3));
      for (int i = 0; i < times_high; ++i) samples.add(code, toFixed(200e3));
    }
    GrnnOptions options;
    options.weighting = weighting;
    return Grnn(options).fitSamples(samples);
  };
  EXPECT_NEAR(train(1, SampleWeighting::kEachSample).pressure[1050], 150e3, 1e-6);
  EXPECT_NEAR(train(9, SampleWeighting::kEachSample).pressure[1050], 190e3, 1e-6);
  const Fit weighted = train(9, SampleWeighting::kEachPressureBin);
  EXPECT_NEAR(weighted.pressure[1050], 150e3, 1e-6);
  EXPECT_NEAR(weighted.support[1050] / train(9, SampleWeighting::kEachSample).support[1050], 1.0, 1e-12);
}

TEST(Grnn, OfAConstantReadingIsTheMeanPressure) {
  const Fit fit = Grnn().fit(histogramOf({{12, 100.0}, {12, 200.0}}, 4095));
  EXPECT_EQ(fit.pressure[0], 150.0);
  EXPECT_EQ(fit.pressure[12], 150.0);
  EXPECT_EQ(fit.pressure[4095], 150.0);
  EXPECT_EQ(fit.support[12], 2.0);
  EXPECT_EQ(fit.support[13], 0.0);
  EXPECT_EQ(Grnn().fit(histogramOf({{7, 5.0}}, 15)).pressure[3], 5.0);
}

TEST(Grnn, RefusesABandwidthOutOfRange) {
  EXPECT_THROW(Grnn(0.0), settings::InputError);
  EXPECT_THROW(Grnn(-1.0), settings::InputError);
  EXPECT_THROW(Grnn(std::nan("")), settings::InputError);
}

}  // namespace
}  // namespace fsr::regression
