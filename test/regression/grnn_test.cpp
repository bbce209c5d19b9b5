#include "regression/grnn/grnn.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "fsr_pressure_map/settings/input_error.h"

namespace fsr::regression {
namespace {

struct Reading {
  std::uint16_t code;
  double pressure;  // [Pa]
};

CodeHistogram histogramOf(const std::vector<Reading>& readings, std::uint16_t full_scale) {
  CodeAccumulator accumulator(full_scale);
  for (const Reading& reading : readings) accumulator.add(reading.code, toFixed(reading.pressure));
  CodeHistogram histogram(full_scale);
  histogram.add(accumulator.take());
  return histogram;
}

// A concave sensor curve with noise, 0 to 620 kPa, codes `low` to `high`.
std::vector<Reading> curve(std::size_t number, double low, double high, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::vector<Reading> readings(number);
  for (Reading& reading : readings) {
    const double pressure = 620e3 * uniform(random);
    const double code = low + (high - low - 20) * std::sqrt(pressure / 620e3) + 20 * uniform(random);
    reading = {static_cast<std::uint16_t>(code), fromFixed(toFixed(pressure))};
  }
  return readings;
}

// The formula in long double: all samples, with the smallest exponent subtracted.
std::vector<double> dense(const std::vector<Reading>& readings, std::uint16_t full_scale, double bandwidth) {
  long double mean = 0, squares = 0;
  for (const Reading& reading : readings) mean += reading.code;
  mean /= static_cast<long double>(readings.size());
  for (const Reading& reading : readings) squares += (reading.code - mean) * (reading.code - mean);
  const long double sigma = bandwidth * std::sqrt(squares / static_cast<long double>(readings.size() - 1));

  std::vector<double> answers;
  for (int code = 0; code <= full_scale; ++code) {
    long double nearest = 1e9L, sum = 0, weights = 0;
    for (const Reading& reading : readings) {
      nearest = std::min(nearest, std::abs(static_cast<long double>(reading.code) - code));
    }
    for (const Reading& reading : readings) {
      const long double d = static_cast<long double>(reading.code) - code;
      const long double excess = (d * d - nearest * nearest) / (2 * sigma * sigma);
      if (excess > 100) continue;  // 1e-43 of the weight of the nearest
      const long double weight = std::exp(-excess);
      sum += weight * reading.pressure;
      weights += weight;
    }
    answers.push_back(static_cast<double>(sum / weights));
  }
  return answers;
}

// Largest difference over all codes, as a share of the range of training pressures; infinite if an answer is
// not finite.
double worstError(const std::vector<Reading>& readings, std::uint16_t full_scale, double bandwidth) {
  const Fit fit = Grnn(bandwidth).fit(histogramOf(readings, full_scale));
  const std::vector<double> expected = dense(readings, full_scale, bandwidth);
  const auto [low, high] = std::minmax_element(
      readings.begin(), readings.end(), [](const auto& a, const auto& b) { return a.pressure < b.pressure; });
  double worst = 0;
  for (std::size_t code = 0; code < expected.size(); ++code) {
    if (!std::isfinite(fit.pressure[code])) return INFINITY;
    worst = std::max(worst, std::abs(fit.pressure[code] - expected[code]));
  }
  return worst / (high->pressure - low->pressure);
}

constexpr double kTolerance = 1e-12;  // of the pressure range

TEST(Grnn, EveryCodeAgreesWithTheDenseFormula) {
  EXPECT_LT(worstError(curve(500, 40, 3500, 1), 4095, kPaperBandwidth), kTolerance);
}

TEST(Grnn, NarrowAndWideBandwidthsAgreeWithTheDenseFormula) {
  const auto readings = curve(200, 40, 3500, 2);
  for (const double bandwidth : {1e-4, 1.0 / 1024, 1.0 / 16, 1.0, 30.0}) {
    EXPECT_LT(worstError(readings, 4095, bandwidth), kTolerance) << "bandwidth " << bandwidth;
  }
}

TEST(Grnn, GapsAndFarCodesHaveTheValueOfTheNearestSample) {
  auto readings = curve(150, 40, 700, 3);
  for (const Reading& reading : curve(150, 3000, 3100, 4)) readings.push_back(reading);
  EXPECT_LT(worstError(readings, 4095, kPaperBandwidth), kTolerance);

  // At a distance of a hundred sigmas and more only the outermost code has weight.
  const Fit fit = Grnn(kPaperBandwidth).fit(histogramOf({{100, 1e3}, {104, 2e3}, {900, 9e3}}, 4095));
  EXPECT_NEAR(fit.pressure[0], 1e3, 1e-9);
  EXPECT_NEAR(fit.pressure[480], 2e3, 1e-9);
  EXPECT_NEAR(fit.pressure[502], 5.5e3, 1e-9);  // midway: equal weights of both neighbours
  EXPECT_NEAR(fit.pressure[4095], 9e3, 1e-9);
  EXPECT_EQ(fit.support[4095], 0.0);
}

TEST(Grnn, SixteenBitCodesAgreeWithTheDenseFormula) {
  EXPECT_LT(worstError(curve(40, 500, 60000, 5), 65535, kPaperBandwidth), kTolerance);
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

TEST(Grnn, PressureBinsNeedTheReadings) {
  GrnnOptions options;
  EXPECT_TRUE(Grnn(options).mergeable());
  options.weighting = SampleWeighting::kEachPressureBin;
  EXPECT_FALSE(Grnn(options).mergeable());
  EXPECT_THROW(Grnn(options).fit(histogramOf(kFive, 4095)), settings::InputError);
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
