// The effects of every rig and those of bending, measured from the chain's readings.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "fsr_pressure_map/settings/input_error.h"
#include "support/simulated_rig.h"

namespace {

using fsr::matrix::Curvature;
using fsr::simulation::SensorChain;
using fsr::simulation::SimulationSettings;
using test_support::cylinder;
using test_support::deviation;
using test_support::mean;
using test_support::readAt;
using test_support::rig;
using test_support::surfaceOf;

// k, P_ref, n, P_s = 3e-4, 620e3, 0.9, 1.2e6; u = 300e3
// 4095 * 3600 * k * (u / P_ref)**n / (1 + (u / P_s)**n)  ->  1787.7089437964119   (Python 3.11)
TEST(StaticCurve, FollowsItsEquation) {
  SensorChain chain(rig());
  EXPECT_NEAR(readAt(chain, 300e3), 1787.7089437964119, 1e-9);
  EXPECT_NEAR(readAt(chain, 620e3), 2849.7293362109044, 1e-9);
  EXPECT_EQ(readAt(chain, 0), 0);
  EXPECT_EQ(readAt(chain, -5e3), 0);
}

TEST(StaticCurve, WithoutSaturationIsAPowerLaw) {
  SimulationSettings settings = rig();
  settings.effects[0].values["saturation_pressure"] = INFINITY;
  SensorChain chain(settings);
  EXPECT_NEAR(readAt(chain, 200e3) / readAt(chain, 100e3), std::pow(2, 0.9), 1e-12);
}

TEST(StaticCurve, ScattersFromTaxelToTaxelAsAsked) {
  SimulationSettings settings = rig("", 64, 64);
  settings.effects[0].values["conductance_scatter"] = 0.05;
  SensorChain chain(settings);
  std::vector<double> logs;
  readAt(chain, 300e3);
  for (const double reading : chain.reading()) logs.push_back(std::log(reading));
  EXPECT_NEAR(deviation(logs), 0.05, 5 * 0.05 / std::sqrt(2 * 4096.0));  // five standard errors
}

TEST(StaticCurve, ScattersInItsExponentAsAsked) {
  SimulationSettings settings = rig("", 64, 64);
  settings.effects[0].values["saturation_pressure"] = INFINITY;
  settings.effects[0].values["exponent_scatter"] = 0.03;
  SensorChain chain(settings);
  readAt(chain, 100e3);
  const std::vector<double> half = chain.reading();
  readAt(chain, 200e3);
  std::vector<double> logs;
  for (std::size_t i = 0; i < half.size(); ++i)
    logs.push_back(std::log(std::log2(chain.reading()[i] / half[i])));
  EXPECT_NEAR(mean(logs), std::log(0.9), 5 * 0.03 / std::sqrt(4096.0));
  EXPECT_NEAR(deviation(logs), 0.03, 5 * 0.03 / std::sqrt(2 * 4096.0));
}

TEST(BendingPreload, ActsLikeMoreGasBehindABend) {
  SensorChain chain(rig("  bending_preload: {amplitude: 34000, curvature_constant: 3, slope: 200}\n"));
  const double curvature = 1 / 0.07;
  const double preload = 34e3 * (1 - std::exp(-curvature / 3)) + 200 * curvature;
  const double flat = readAt(chain, 100e3 + preload);
  chain.mount(cylinder(0.07));
  EXPECT_NEAR(readAt(chain, 100e3), flat, 1e-9);
}

TEST(BendingPreload, SaturatesWithCurvatureAndIsLessWhereConcave) {
  SensorChain chain(
      rig("  bending_preload: {amplitude: 34000, curvature_constant: 3, concave_share: 0.6}\n"));
  std::vector<double> at_rest;
  for (const double radius : {1e6, 0.13, 0.05, -0.05}) {
    chain.mount(cylinder(radius));
    at_rest.push_back(readAt(chain, 0));
  }
  EXPECT_LT(at_rest[0], 5);
  EXPECT_GT(at_rest[1], 200);
  EXPECT_GT(at_rest[2], at_rest[1]);
  EXPECT_LT(at_rest[2], 1.1 * at_rest[1]);
  EXPECT_NEAR(at_rest[3] / at_rest[2], std::pow(0.6, 0.9), 0.01);
}

TEST(BendingGain, LowersTheConductanceByItsShare) {
  SensorChain chain(rig("  bending_gain: {change: -0.2, curvature_constant: 6}\n"));
  const double flat = readAt(chain, 300e3);
  chain.mount(cylinder(0.05));
  EXPECT_NEAR(readAt(chain, 300e3) / flat, 1 - 0.2 * (1 - std::exp(-20.0 / 6)), 1e-12);
}

TEST(BendingGain, ScattersBetweenCurvaturesButNotOnTheFlat) {
  SensorChain chain(rig(
      "  bending_gain: {change: 0, scatter: 0.03, curvature_constant: 0.5, scatter_length: 1}\n", 64, 64));
  readAt(chain, 300e3);
  const std::vector<double> flat = chain.reading();
  EXPECT_EQ(flat, std::vector<double>(4096, flat[0]));
  std::vector<std::vector<double>> gains;
  for (const double curvature : {12.0, 12.01, 18.0}) {
    chain.mount(surfaceOf({curvature, 0, 0}));
    readAt(chain, 300e3);
    gains.push_back(chain.reading());
    for (double& gain : gains.back()) gain = gain / flat[0] - 1;
    EXPECT_NEAR(deviation(gains.back()), 0.03, 0.002) << curvature;
  }
  EXPECT_NEAR(gains[0][17], gains[1][17], 0.002);  // smooth in curvature
  double covariance = 0;
  for (std::size_t i = 0; i < 4096; ++i) covariance += gains[0][i] * gains[2][i] / 4096;
  EXPECT_NEAR(covariance / (0.03 * 0.03), 0, 0.1);  // surfaces far apart know nothing of each other
}

TEST(Bending, TaxelsAnswerToTheirOwnPrincipalCurvature) {
  const char* bending = "  bending_preload: {}\n  bending_gain: {}\n";
  // The eigenvalues of [[9, 2], [2, 6]] are 10 and 5; of [[-6, 0], [0, 3]] the larger one is -6.
  SensorChain saddle(rig(bending)), round(rig(bending));
  std::vector<Curvature> curvatures(6);
  curvatures[1] = {9, 6, 2};
  curvatures[2] = {-6, 3, 0};
  saddle.mount({"limb", 1, curvatures, {}});
  round.mount(surfaceOf({0, 10, 0}));
  EXPECT_NEAR(readAt(saddle, 200e3, 1), readAt(round, 200e3, 1), 1e-9);
  round.mount(surfaceOf({-6, 0, 0}));
  EXPECT_EQ(readAt(saddle, 200e3, 2), readAt(round, 200e3, 2));
  round.mount(surfaceOf({}));
  EXPECT_EQ(readAt(saddle, 200e3, 0), readAt(round, 200e3, 0));
}

TEST(WhiteNoise, HasItsDeviationAndNoMemory) {
  SensorChain quiet(rig()), noisy(rig("  white_noise: {absolute: 30, relative: 0.02}\n"));
  const double level = readAt(quiet, 300e3);
  std::vector<double> noise, next;
  for (std::uint64_t scan = 0; scan < 20000; ++scan) noise.push_back(readAt(noisy, 300e3, 2, scan) - level);
  const double expected = std::hypot(30, 0.02 * level);
  EXPECT_NEAR(mean(noise), 0, 5 * expected / std::sqrt(20000.0));
  EXPECT_NEAR(deviation(noise), expected, 5 * expected / std::sqrt(2 * 20000.0));
  double lag = 0;
  for (std::size_t i = 1; i < noise.size(); ++i) lag += noise[i] * noise[i - 1] / 20000;
  EXPECT_NEAR(lag / (expected * expected), 0, 5 / std::sqrt(20000.0));
}

TEST(WhiteNoise, BelongsToScanAndTaxelWhateverTheOrderAndSizeOfTheMatrix) {
  const char* noise = "  white_noise: {absolute: 30}\n";
  SensorChain small(rig(noise, 1, 2)), large(rig(noise, 5, 5));
  const double late = readAt(small, 1e5, 1, 99);
  EXPECT_NE(readAt(large, 1e5, 1, 98), late);
  EXPECT_EQ(readAt(large, 1e5, 1, 99), late);
}

TEST(Converter, RoundsAndClips) {
  SimulationSettings settings = rig();
  auto& curve = settings.effects[0].values;  // a straight line, 4,000 counts at 620 kPa
  curve["exponent"] = 1;
  curve["saturation_pressure"] = INFINITY;
  curve["conductance"] = 4000.0 / (4095.0 * 3600.0);
  SensorChain chain(settings);
  EXPECT_EQ(chain.read({0, 310e3 + 0.4 * 155, 0})[0], 2000);
  EXPECT_EQ(chain.read({0, 310e3 + 0.6 * 155, 0})[0], 2001);
  EXPECT_EQ(chain.read({0, 793e3, 0})[0], 4095);
  EXPECT_EQ(chain.read({0, -10e3, 0})[0], 0);
}

TEST(Converter, RefusesAFractionalFullScale) {
  SimulationSettings settings = rig();
  for (auto& effect : settings.effects) {
    if (effect.id == "converter") effect.values["full_scale"] = 4095.5;
  }
  EXPECT_THROW(SensorChain{settings}, fsr::settings::InputError);
}

}  // namespace
