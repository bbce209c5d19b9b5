// Each effect, measured from the chain's readings.

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <set>

#include "fsr_pressure_map/simulation/effects/effect_library.h"
#include "fsr_pressure_map/simulation/sensor_chain.h"

namespace {

using fsr::Curvature;
using fsr::EffectEntry;
using fsr::EffectValues;
using fsr::SensorChain;
using fsr::SimulationSettings;
using fsr::Surface;

Surface surfaceOf(const Curvature& curvature) {
  return {"bent", 1, {curvature}, {}};
}
Surface cylinder(double radius) {
  return surfaceOf({1 / radius, 0, 0});
}

/// The usual static curve without scatter, the usual converter, and `more`, indented YAML of effects.
SimulationSettings rig(const std::string& more = "", int rows = 2, int columns = 3) {
  return fsr::readSimulation(fsr::Settings::fromText(
      "simulation: test\nmatrix: {rows: " + std::to_string(rows) + ", columns: " + std::to_string(columns) +
          "}\neffects:\n  static_curve: {conductance_scatter: 0}\n  converter: {}\n" + more,
      "test.yaml"));
}

double readAt(SensorChain& chain, double pressure, std::size_t taxel = 0, std::uint64_t scan = 0) {
  chain.read({0, pressure, scan});
  return chain.reading()[taxel];
}

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / double(values.size());
}

double deviation(const std::vector<double>& values) {
  const double centre = mean(values);
  double sum = 0;
  for (const double value : values) sum += (value - centre) * (value - centre);
  return std::sqrt(sum / double(values.size() - 1));
}

/// Readings of all taxels over two cycles on a cylinder, unrounded.
std::vector<double> run(const SimulationSettings& settings) {
  SensorChain chain(settings);
  chain.mount(cylinder(0.07));
  const fsr::PressureProfile profile = fsr::pressureProfile({500e3, 20e3, 30e3, 2, 3, 2});
  std::vector<double> readings;
  for (int scan = 0; scan * 0.5 < profile.duration(); ++scan) {
    chain.read({scan * 0.5, profile.at(scan * 0.5), static_cast<std::uint64_t>(scan)});
    readings.insert(readings.end(), chain.reading().begin(), chain.reading().end());
  }
  return readings;
}

EffectValues valuesOf(const EffectEntry& entry, bool neutral) {
  EffectValues values;
  for (const auto& parameter : entry.info.parameters) {
    values[parameter.name] = neutral && !std::isnan(parameter.neutral) ? parameter.neutral : parameter.usual;
  }
  return values;
}

TEST(EffectLibrary, EveryEffectDescribesItself) {
  std::set<std::string> ids;
  for (const EffectEntry& entry : fsr::effectLibrary()) {
    EXPECT_TRUE(ids.insert(entry.info.id).second) << entry.info.id << " twice";
    for (const std::string& text : {entry.info.summary, entry.info.equation, entry.info.source}) {
      EXPECT_FALSE(text.empty()) << entry.info.id;
    }
    for (const auto& parameter : entry.info.parameters) {
      EXPECT_FALSE(parameter.meaning.empty()) << parameter.name;
      EXPECT_TRUE(parameter.permitted.contains(parameter.usual)) << entry.info.id << '.' << parameter.name;
      EXPECT_TRUE(std::isnan(parameter.neutral) || parameter.permitted.contains(parameter.neutral))
          << entry.info.id << '.' << parameter.name;
    }
  }
}

TEST(EffectLibrary, AnEffectAtNeutralChangesNothingBitForBit) {
  const std::vector<double> without = run(rig());
  for (const EffectEntry& entry : fsr::effectLibrary()) {
    if (entry.info.required) continue;
    SimulationSettings settings = rig();
    settings.effects.push_back({entry.info.id, valuesOf(entry, true)});
    EXPECT_EQ(run(settings), without) << entry.info.id;
    settings.effects.back().values = valuesOf(entry, false);
    EXPECT_NE(run(settings), without) << entry.info.id << " does nothing at its usual size";
  }
}

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

/// A sensor of straight line, 4,000 counts at 620 kPa, with `more`.
SimulationSettings straightRig(const std::string& more) {
  SimulationSettings settings = rig(more);
  auto& curve = settings.effects[more.find("hysteresis") != std::string::npos ? 1 : 0].values;
  curve["exponent"] = 1;
  curve["saturation_pressure"] = INFINITY;
  curve["conductance"] = 4000.0 / (4095.0 * 3600.0);
  return settings;
}

TEST(Hysteresis, OpensTheLoopByItsShareOfFullScale) {
  SensorChain chain(straightRig("  hysteresis: {loop_width: 0.05, span: 620e3, reach: 100e3}\n"));
  double up = 0, down = 0;
  for (int cycle = 0; cycle < 2; ++cycle) {
    for (double p = 0; p <= 620e3; p += 10e3) up = p == 310e3 ? readAt(chain, p) : (readAt(chain, p), up);
    for (double p = 620e3; p >= 0; p -= 10e3) down = p == 310e3 ? readAt(chain, p) : (readAt(chain, p), down);
  }
  EXPECT_NEAR((down - up) / 4000, 0.05, 1e-9);
}

TEST(Hysteresis, DoesNotDependOnTheRate) {
  const auto settings = straightRig("  hysteresis: {loop_width: 0.08}\n");
  SensorChain slow(settings), fast(settings);
  double from = 0;
  for (const double target : {620e3, 100e3, 400e3, 0.0}) {
    for (int i = 0; i < 500; ++i) readAt(slow, from + (target - from) * i / 500);
    EXPECT_DOUBLE_EQ(readAt(slow, target), readAt(fast, target));
    from = target;
  }
}

TEST(Hysteresis, RefusesALoopThatWouldRunBackwards) {
  EXPECT_THROW(SensorChain{rig("  hysteresis: {loop_width: 0.5, reach: 10e3}\n")}, fsr::InputError);
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
  SensorChain chain(straightRig(""));
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
  EXPECT_THROW(SensorChain{settings}, fsr::InputError);
}

}  // namespace
