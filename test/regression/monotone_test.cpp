#include "regression/monotone.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "fsr_pressure_map/settings/input_error.h"
#include "regression/grnn/grnn.h"

namespace fsr::regression {
namespace {

std::vector<double> levels(const std::vector<double>& values, const std::vector<double>& weights) {
  std::vector<double> fitted(values.size());
  for (const IsotonicBlock& block : isotonicRegression(values, weights)) {
    std::fill(fitted.begin() + static_cast<std::ptrdiff_t>(block.begin),
              fitted.begin() + static_cast<std::ptrdiff_t>(block.end), block.level);
  }
  return fitted;
}

TEST(IsotonicRegression, AgreesWithScikitLearnAndR) {
  const std::vector<double> y = {1, 3, 2, 2, 5, 4, 4.5, 7, 6.5, 9};
  // scikit-learn 1.2.1: IsotonicRegression().fit(range(10), y, [1, 2, 1, 4, 1, 3, 2, 1, 2,
  // 5]).predict(range(10))
  const std::vector<double> weighted = {1.0,
                                        2.2857142857142856,
                                        2.2857142857142856,
                                        2.2857142857142856,
                                        4.25,
                                        4.25,
                                        4.5,
                                        6.666666666666667,
                                        6.666666666666667,
                                        9.0};
  const std::vector<double> fitted = levels(y, {1, 2, 1, 4, 1, 3, 2, 1, 2, 5});
  for (std::size_t i = 0; i < y.size(); ++i) EXPECT_NEAR(fitted[i], weighted[i], 1e-14) << i;
  // R 4.2.2: isoreg(y)$yf
  const std::vector<double> alike = {
      1, 2.333333333333333, 2.333333333333333, 2.333333333333333, 4.5, 4.5, 4.5, 6.75, 6.75, 9};
  const std::vector<double> unweighted = levels(y, std::vector<double>(10, 1.0));
  for (std::size_t i = 0; i < y.size(); ++i) EXPECT_NEAR(unweighted[i], alike[i], 1e-14) << i;
}

constexpr double kScatter = 40.0;  // [counts]

// A concave curve, 60 to 3360 counts over 0 to 620 kPa.
double readingAt(double pressure) {
  return 60 + 3300 * std::pow(pressure / 620e3, 0.7);
}

// Scans at the pressures that `draw` gives [Pa].
template <typename Draw>
CodeSamples scans(std::size_t number, unsigned seed, Draw draw, double sign = 1.0) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0.0, kScatter);
  CodeSamples samples;
  samples.full_scale = 4095;
  for (std::size_t i = 0; i < number; ++i) {
    const double pressure = draw(random);
    const double reading = sign * readingAt(pressure) + normal(random) + (sign < 0 ? 4000 : 0);
    samples.add(static_cast<std::uint16_t>(std::clamp(std::round(reading), 0.0, 4095.0)), toFixed(pressure));
  }
  return samples;
}

double evenly(std::mt19937& random) {
  return std::uniform_real_distribution<double>(0, 620e3)(random);
}

// Pressures that are mostly near 450 kPa.
double longDwell(std::mt19937& random) {
  return random() % 10 == 0 ? evenly(random) : std::uniform_real_distribution<double>(430e3, 470e3)(random);
}

TEST(Monotone, RecoversTheCurve) {
  const MonotoneCurve curve(scans(6000, 1, evenly));
  for (double pressure = 20e3; pressure < 600e3; pressure += 20e3) {
    EXPECT_NEAR(curve.pressureAt(readingAt(pressure)), pressure, 6e3) << pressure;
  }
}

TEST(Monotone, InvertsAFallingCurve) {
  const MonotoneCurve curve(scans(6000, 2, evenly, -1.0));
  EXPECT_NEAR(curve.pressureAt(4000 - readingAt(100e3)), 100e3, 6e3);
  EXPECT_NEAR(curve.pressureAt(4000 - readingAt(500e3)), 500e3, 6e3);
}

TEST(Monotone, DoesNotDependOnHowLongTheChamberHeldAPressure) {
  // Readings near a long dwell: the mean of the GRNN is biased towards the dwell, the curve is not.
  const CodeSamples dwell = scans(20000, 3, longDwell);
  const Fit monotone = Monotone().fitSamples(dwell), grnn = Grnn().fitSamples(dwell);
  for (const double pressure : {415e3, 485e3}) {
    const auto code = static_cast<std::size_t>(readingAt(pressure));
    EXPECT_NEAR(monotone.pressure[code], pressure, 4e3);
    EXPECT_GT(std::abs(grnn.pressure[code] - pressure), 8e3);
  }
}

TEST(Monotone, KnotsIncreaseStrictlyAndTheTableDoesNotDecrease) {
  const CodeSamples samples = scans(3000, 4, evenly);
  const MonotoneCurve curve(samples);
  for (std::size_t i = 1; i < curve.knotReading().size(); ++i) {
    EXPECT_LT(curve.knotReading()[i - 1], curve.knotReading()[i]);
    EXPECT_LT(curve.knotPressure()[i - 1], curve.knotPressure()[i]);
  }
  const Fit fit = Monotone().fitSamples(samples);
  EXPECT_TRUE(std::is_sorted(fit.pressure.begin(), fit.pressure.end()));
}

TEST(Monotone, SupportIsThatOfTheNeighbouringKnots) {
  const MonotoneCurve curve(scans(6000, 7, evenly));
  const double left = curve.knotReading()[10], right = curve.knotReading()[11];
  const double at_left = curve.supportAt(left), at_right = curve.supportAt(right);
  EXPECT_NEAR(curve.supportAt((left + right) / 2), 4 / (1 / at_left + 1 / at_right), 1e-6);
}

}  // namespace
}  // namespace fsr::regression
