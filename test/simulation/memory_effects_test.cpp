// Effects that remember, measured from the counts: each does what its source says, in direction and size.

#include <gtest/gtest.h>

#include <cmath>

#include "fsr_pressure_map/settings/input_error.h"
#include "simulation/pressure_profile.h"
#include "support/simulated_rig.h"

namespace {

using fsr::settings::InputError;
using fsr::simulation::SensorChain;
using test_support::cylinder;
using test_support::fitLine;
using test_support::kStraightCounts;
using test_support::kStraightSpan;
using test_support::profile;
using test_support::readAlong;
using test_support::Reading;
using test_support::readingAt;
using test_support::straightRig;

constexpr double kCount = 1 / kStraightCounts;  // one step of the converter, share of full scale

std::vector<Reading> along(const std::string& effect, const fsr::simulation::PressureProfile& course,
                           double period) {
  SensorChain chain(straightRig(effect));
  return readAlong(chain, course, period);
}

/// Share of full scale.
double share(const Reading& reading) {
  return reading.counts / kStraightCounts;
}

// A reading of the ramp is 0.005 s off at most at 17 kPa/s, twice in a difference, and rounded.
constexpr double kHalfScan = 2 * (0.005 * 17e3 / kStraightSpan + kCount);

// --- hysteresis --------------------------------------------------------------------------------------

// Two cycles to 620 kPa at 17 kPa/s: at 310 kPa after 18.235 s up, 54.706 s down (and 72.941 s later again).
const fsr::simulation::PressureProfile kTwoCycles =
    fsr::simulation::pressureProfile({620e3, 17e3, 17e3, 0, 0, 2});
constexpr double kCycle = 2 * 620.0 / 17;

TEST(Hysteresis, OpensTheLoopByItsShareOfFullScale) {
  for (const double width : {0.05, 0.10}) {  // Tangio, Interlink
    const auto readings =
        along("  hysteresis: {loop_width: " + std::to_string(width) + "}\n", kTwoCycles, 0.01);
    const double up = share(readingAt(readings, 1.25 * kCycle)),
                 down = share(readingAt(readings, 1.75 * kCycle));
    EXPECT_NEAR(down - up, width, kHalfScan);
    EXPECT_NEAR((up + down) / 2, 0.5, 0.001);
  }
}

TEST(Hysteresis, DoesNotDependOnTheRate) {
  const std::string effect = "  hysteresis: {loop_width: 0.08}\n";
  const auto slow = along(effect, profile({{0, 0}, {1000, 6e5}, {1800, 1e5}, {2300, 4e5}, {3000, 0}}), 1);
  const auto fast = along(effect, profile({{0, 0}, {10, 6e5}, {18, 1e5}, {23, 4e5}, {30, 0}}), 0.01);
  ASSERT_EQ(slow.size(), fast.size());
  for (std::size_t i = 0; i < slow.size(); ++i) EXPECT_NEAR(slow[i].counts, fast[i].counts, 1);
}

TEST(Hysteresis, ReturnsToTheOldBranchAfterAMinorLoop) {  // wiping-out
  for (const std::string form : {"", ", rayleigh: 1"}) {
    const std::string effect = "  hysteresis: {loop_width: 0.08" + form + "}\n";
    const auto straight = along(effect, profile({{0, 0}, {62, 620e3}}), 0.1);
    const auto looped =
        along(effect, profile({{0, 0}, {40, 400e3}, {60, 200e3}, {80, 400e3}, {102, 620e3}}), 0.1);
    EXPECT_GT(readingAt(looped, 50).counts, readingAt(straight, 30).counts + 500);  // the loop was open
    for (const double after : {0.0, 5.0, 22.0}) {
      EXPECT_NEAR(readingAt(looped, 80 + after).counts, readingAt(straight, 40 + after).counts, 1);
    }
  }
}

TEST(Hysteresis, OneSidedLeavesTheFirstLoadingAloneAndOpensAsWide) {
  const std::string effect = "  hysteresis: {loop_width: 0.05, one_sided: 1}\n";
  const auto readings = along(effect, kTwoCycles, 0.01), without = along("", kTwoCycles, 0.01);
  for (const double quarter : {0.05, 0.25, 0.45}) {
    EXPECT_EQ(readingAt(readings, quarter * kCycle).counts, readingAt(without, quarter * kCycle).counts);
  }
  EXPECT_NEAR(share(readingAt(readings, 0.75 * kCycle)) - share(readingAt(without, 0.75 * kCycle)), 0.05,
              2 * kCount);
}

constexpr double kReach = 150e3;  // usual [Pa]

/// Second pass of a cycle that is `width` [Pa] wide and has its middle at 310 kPa: width of its loop at that
/// pressure and area of its loop, in counts and in counts times Pa.
struct MinorLoop {
  double width = 0;
  double area = 0;
};
MinorLoop minorLoop(const std::string& effect, double width) {
  const double low = 310e3 - width / 2, high = 310e3 + width / 2;
  const auto readings =
      along(effect, profile({{0, 0}, {50, high}, {150, low}, {250, high}, {350, low}, {450, high}}), 1);
  MinorLoop loop;
  loop.width = readingAt(readings, 300).counts - double(readingAt(readings, 400).counts);
  for (int second = 250; second < 450; ++second) {
    const Reading &from = readingAt(readings, second), &to = readingAt(readings, second + 1);
    loop.area -= 0.5 * (from.counts + to.counts) * (to.pressure - from.pressure);
  }
  return loop;
}

// The share of the weight on plays is h = loop_width P_span / R, because the mean radius is R / 2.
TEST(Hysteresis, ByRayleighsLawOpensWithTheSquareOfTheCycleAndItsAreaWithTheCube) {
  const std::string effect = "  hysteresis: {loop_width: 0.2, rayleigh: 1}\n";
  const double share = 0.2 * kStraightSpan / kReach, counts = kStraightCounts / kStraightSpan;
  for (const double width : {40e3, 100e3, 200e3, 300e3}) {
    const MinorLoop loop = minorLoop(effect, width);
    EXPECT_NEAR(loop.width, share / (8 * kReach) * width * width * counts, 3) << width;
    const double area = share / (12 * kReach) * std::pow(width, 3) * counts;
    EXPECT_NEAR(loop.area, area, 0.01 * area) << width;
  }
  EXPECT_EQ(minorLoop("  hysteresis: {loop_width: 0.2}\n", 40e3).width, 0);  // narrower than any play
}

TEST(Hysteresis, ByRayleighsLawLoadsAlongAParabola) {
  const auto readings =
      along("  hysteresis: {loop_width: 0.2, rayleigh: 1}\n", profile({{0, 0}, {62, 620e3}, {124, 0}}), 0.1);
  const double share = 0.2 * kStraightSpan / kReach, counts = kStraightCounts / kStraightSpan;
  const double top = readingAt(readings, 62).counts;
  for (const double change : {50e3, 150e3, 300e3}) {  // du = (1 - h) dP + h / (4 R) dP |dP|
    const double expected = ((1 - share) * change + share / (4 * kReach) * change * change) * counts;
    EXPECT_NEAR(top - readingAt(readings, 62 + change / 10e3).counts, expected, 4) << change;
  }
}

TEST(Hysteresis, OfEitherFormHasTheSameFullLoop) {
  for (const std::string form : {"0", "0.5", "1"}) {
    const auto readings =
        along("  hysteresis: {loop_width: 0.05, rayleigh: " + form + "}\n", kTwoCycles, 0.01);
    EXPECT_NEAR(share(readingAt(readings, 1.75 * kCycle)) - share(readingAt(readings, 1.25 * kCycle)), 0.05,
                kHalfScan)
        << form;
  }
}

TEST(Hysteresis, RefusesALoopThatWouldRunBackwards) {
  EXPECT_THROW(SensorChain{straightRig("  hysteresis: {loop_width: 0.5, reach: 10e3}\n")}, InputError);
  EXPECT_THROW(SensorChain{straightRig("  hysteresis: {loop_width: 0.3, rayleigh: 1}\n")}, InputError);
}

// --- creep -------------------------------------------------------------------------------------------

const fsr::simulation::PressureProfile kHold = profile({{0, 0}, {0.1, 310e3}, {1000, 310e3}});
const fsr::simulation::PressureProfile kStepAndHold =
    profile({{0, 0}, {1, 310e3}, {3000, 310e3}, {3001, 0}, {33000, 0}});

/// Rise per decade of time since the step, share of the reading just after it.
double perDecade(const std::vector<Reading>& readings, double from, double to) {
  std::vector<double> decades, shares;
  const double start = readingAt(readings, 0.2).counts;
  for (double time = from; time <= to; time *= 1.1) {
    decades.push_back(std::log10(time));
    shares.push_back(readingAt(readings, time).counts / start);
  }
  return fitLine(decades, shares).slope;
}

TEST(Creep, RisesByItsShareInEachDecadeOfTime) {
  for (const double rate : {0.02, 0.05}) {  // Tangio, Interlink
    const auto readings = along("  creep: {per_decade: " + std::to_string(rate) + "}\n", kHold, 0.1);
    EXPECT_NEAR(perDecade(readings, 3, 30), rate, 0.02 * rate);
    EXPECT_NEAR(perDecade(readings, 30, 300), rate, 0.02 * rate);
  }
}

TEST(Creep, FadesWhenTheLoadIsGone) {
  const auto readings = along("  creep: {per_decade: 0.03}\n", kStepAndHold, 1);
  double before = readingAt(readings, 3001).counts;
  EXPECT_GT(before, 0.05 * 0.5 * kStraightCounts);
  for (const double after : {10.0, 100.0, 1000.0, 10000.0}) {
    const double now = readingAt(readings, 3000 + after).counts;
    EXPECT_LT(now, 0.9 * before);
    before = now;
  }
  EXPECT_LT(before, 0.006 * 0.5 * kStraightCounts);
}

TEST(Creep, IsTheSameAtAnyScanRate) {
  const auto course = profile({{0, 0}, {1, 310e3}, {300, 310e3}, {301, 0}, {600, 0}});
  const auto coarse = along("  creep: {per_decade: 0.05}\n", course, 1);
  const auto fine = along("  creep: {per_decade: 0.05}\n", course, 0.1);
  for (const Reading& reading : coarse) EXPECT_EQ(reading.counts, readingAt(fine, reading.time).counts);
}

TEST(Creep, OfTheSensitivityShowsOnlyUnderLoad) {
  const std::string effect = "  creep: {per_decade: 0.03, gain_share: 1, span: 310e3}\n";
  EXPECT_NEAR(perDecade(along(effect, kHold, 0.1), 30, 300), 0.03, 0.02 * 0.03);
  EXPECT_EQ(readingAt(along(effect, kStepAndHold, 1), 3001).counts, 0);
}

TEST(Creep, RefusesTimeConstantsInTheWrongOrder) {
  EXPECT_THROW(SensorChain{straightRig("  creep: {fastest: 100, slowest: 1}\n")}, InputError);
}

// --- relaxation --------------------------------------------------------------------------------------

TEST(Relaxation, LosesItsShareWithOneTimeConstant) {
  const auto readings = along("  relaxation: {relaxed_share: 0.1, fastest: 60, slowest: 60}\n", kHold, 0.1);
  for (const double time : {10.0, 60.0, 200.0, 900.0}) {
    const double expected = 1 - 0.1 * -std::expm1(-time / 60);
    EXPECT_NEAR(share(readingAt(readings, time)) / 0.5, expected, 1e-4) << time;
  }
}

// The n time constants lie two a decade: between the fastest and the slowest the reading falls by 2 g / n in
// each decade. From 0.1 s to 1e4 s there are 11.
TEST(Relaxation, FallsByTheSameShareInEachDecadeOfTime) {
  const auto readings = along("  relaxation: {relaxed_share: 0.2, fastest: 0.1, slowest: 1e4}\n", kHold, 0.1);
  const double start = share(readingAt(readings, 0.2)) / 0.5;  // perDecade() divides by it
  EXPECT_NEAR(perDecade(readings, 3, 30) * start, -2 * 0.2 / 11, 0.02 * 2 * 0.2 / 11);
  EXPECT_NEAR(perDecade(readings, 30, 300) * start, -2 * 0.2 / 11, 0.02 * 2 * 0.2 / 11);
}

TEST(Relaxation, RecoversAtALowerLoad) {
  const auto readings = along("  relaxation: {relaxed_share: 0.1}\n",
                              profile({{0, 0}, {1, 310e3}, {3000, 310e3}, {3001, 155e3}, {33000, 155e3}}), 1);
  const double final = 0.25 * 0.9 * kStraightCounts;
  double before = readingAt(readings, 3002).counts;
  EXPECT_LT(before, final - 0.04 * 0.25 * kStraightCounts);
  for (const double after : {10.0, 100.0, 1000.0}) {
    const double now = readingAt(readings, 3000 + after).counts;
    EXPECT_GT(now, before);
    before = now;
  }
  EXPECT_NEAR(readings.back().counts, final, 1);
}

TEST(Relaxation, OpensTheLoopInTheOtherSense) {
  const auto readings = along("  relaxation: {relaxed_share: 0.1}\n", kTwoCycles, 0.1);
  EXPECT_GT(share(readingAt(readings, 1.25 * kCycle)), share(readingAt(readings, 1.75 * kCycle)) + 0.01);
}

TEST(Relaxation, HasAnElasticResponseWithAnExponent) {
  const auto readings =
      along("  relaxation: {relaxed_share: 0.1, fastest: 10, slowest: 10, exponent: 2}\n", kHold, 0.1);
  EXPECT_NEAR(share(readings.back()) / 0.5, 1 - 0.1 * 0.5, 1e-4);  // x = 620 kPa (1/2)^2 = P_e / 2
}

TEST(Relaxation, IsTheSameAtAnyScanRate) {
  const auto course = profile({{0, 0}, {1, 310e3}, {300, 310e3}, {301, 0}, {600, 200e3}});
  const auto coarse = along("  relaxation: {relaxed_share: 0.3}\n", course, 1);
  const auto fine = along("  relaxation: {relaxed_share: 0.3}\n", course, 0.1);
  for (const Reading& reading : coarse) EXPECT_EQ(reading.counts, readingAt(fine, reading.time).counts);
}

TEST(Relaxation, RefusesTimeConstantsInTheWrongOrder) {
  EXPECT_THROW(SensorChain{straightRig("  relaxation: {fastest: 100, slowest: 1}\n")}, InputError);
}

// --- cavity ------------------------------------------------------------------------------------------

TEST(SealLeak, LosesTheLoadWithItsTimeConstant) {
  const auto readings = along("  seal_leak: {time_constant: 600}\n", kStepAndHold, 1);
  std::vector<double> times, logs;
  for (double time = 10; time < 2000; time += 10) {
    times.push_back(time);
    logs.push_back(std::log(readingAt(readings, time).counts));
  }
  EXPECT_NEAR(-1 / fitLine(times, logs).slope, 600, 6);
  EXPECT_EQ(readingAt(readings, 3010).counts, 0);  // the cavity, still full, lifts the sheet
}

TEST(SealLeak, LosesNoMoreThanTheShareThatItReaches) {
  const auto readings = along("  seal_leak: {time_constant: 60, share: 0.3}\n", kStepAndHold, 1);
  EXPECT_NEAR(readingAt(readings, 2900).counts, 0.7 * 0.5 * kStraightCounts, 2);
}

constexpr double kAmbient = 101325;  // [Pa]
const std::string kOrifice = "  seal_leak: {time_constant: 600, orifice_share: 1, critical_ratio: 0.5";

// The chamber holds p_1 = 620 kPa gauge. While the flow is choked, the cavity fills at (1 - b) p_1 / tau.
// Then p_cav / p_1 = b + (1 - b) sin((t - t_b) / tau), which is 1 at t_b + tau pi / 2.
TEST(SealLeak, ThroughAnOrificeFillsEvenlyWhileChokedAndInAFiniteTime) {
  const auto readings = along(kOrifice + "}\n", profile({{0, 620e3}, {1600, 620e3}}), 1);
  const double upstream = 620e3 + kAmbient, rate = 0.5 * upstream / 600;
  const double choked_until = (0.5 * upstream - kAmbient) / rate;
  ASSERT_NEAR(choked_until, 431.4, 0.1);
  for (const double time : {100.0, 200.0, 430.0, 500.0, 800.0, 1300.0}) {
    const double cavity = time < choked_until
                              ? rate * time
                              : upstream * (0.5 + 0.5 * std::sin((time - choked_until) / 600)) - kAmbient;
    EXPECT_NEAR(readingAt(readings, time).counts, (620e3 - cavity) / kStraightSpan * kStraightCounts, 3)
        << time;
  }
  EXPECT_EQ(readingAt(readings, std::ceil(choked_until + 600 * 1.5708) + 1).counts, 0);
}

// From a full cavity at 620 kPa to 200 kPa: while choked, the absolute pressure of the cavity falls as
// exp(-(1 - b) t / tau), here until 200 kPa + ambient is half of it, for 215 s.
TEST(SealLeak, ThroughAnOrificeEmptiesExponentiallyWhileChoked) {
  const auto readings = along(kOrifice + ", share: 0.3}\n",
                              profile({{0, 620e3}, {1600, 620e3}, {1600.01, 200e3}, {2000, 200e3}}), 0.1);
  for (const double time : {50.0, 100.0, 200.0}) {
    const double cavity = (620e3 + kAmbient) * std::exp(-0.5 * time / 600) - kAmbient;
    EXPECT_NEAR(readingAt(readings, 1600 + time).counts,
                (200e3 - 0.3 * cavity) / kStraightSpan * kStraightCounts, 3)
        << time;
  }
}

TEST(SealLeak, ThroughAnOrificeIsTheSameAtAnyScanRate) {
  const auto course = profile({{0, 0}, {30, 500e3}, {400, 400e3}, {420, 50e3}, {900, 50e3}});
  const auto coarse = along(kOrifice + ", share: 0.1}\n", course, 10);
  const auto fine = along(kOrifice + ", share: 0.1}\n", course, 0.1);
  const double tolerance = 1e-4 * kStraightCounts;
  for (const Reading& reading : coarse) {
    EXPECT_NEAR(reading.counts, readingAt(fine, reading.time).counts, tolerance);
  }
}

TEST(SealLeak, WithHardlyAnyOrificeIsLaminar) {
  const auto laminar = along("  seal_leak: {time_constant: 600}\n", kStepAndHold, 1);
  const auto nearly = along("  seal_leak: {time_constant: 600, orifice_share: 1e-9}\n", kStepAndHold, 1);
  ASSERT_EQ(laminar.size(), nearly.size());
  for (std::size_t i = 0; i < laminar.size(); ++i) EXPECT_NEAR(laminar[i].counts, nearly[i].counts, 1);
}

TEST(TrappedGas, PressesBackByBoylesLawWhateverTheHistory) {
  const auto readings = along("  trapped_gas: {closing: 0.3, half_pressure: 200e3}\n", kTwoCycles, 0.01);
  // p_a (1 / (1 - c P / (P + P_h)) - 1) for P = 310e3  ->  22597.66 Pa   (Python 3.11)
  const double expected = (310e3 - 22597.66) / kStraightSpan * kStraightCounts;
  const double tolerance = 2 + 17e3 * 0.005 / kStraightSpan * kStraightCounts;
  EXPECT_NEAR(readingAt(readings, 0.25 * kCycle).counts, expected, tolerance);
  EXPECT_NEAR(readingAt(readings, 0.75 * kCycle).counts, expected, tolerance);
}

// --- gain over time ----------------------------------------------------------------------------------

/// Reading at 310 kPa after an hour at a temperature, share of that at 23 degree Celsius.
double warm(const std::string& effect, double temperature) {
  SensorChain chain(straightRig(effect));
  const auto readings = readAlong(chain, profile({{0, 310e3}, {10, 310e3}}), 1, 0, temperature);
  return readings.back().counts / (0.5 * kStraightCounts);
}

TEST(Temperature, ChangesTheReadingByItsShareAKelvin) {
  for (const double coefficient : {0.0036, -0.0025}) {
    const std::string effect = "  temperature: {coefficient: " + std::to_string(coefficient) + "}\n";
    EXPECT_NEAR(warm(effect, 24) - 1, coefficient, 0.01 * std::abs(coefficient) + kCount * 2);
    EXPECT_NEAR(warm(effect, 22) - 1, -coefficient, 0.01 * std::abs(coefficient) + kCount * 2);
  }
}

// Resistance -5 % at -40 and -15 % at +85 degree Celsius (Interlink):
//   T0 = 296.15; x = lambda d: d * T0 / (T0 + d)
//   numpy.linalg.solve([[x(-63), 63**2], [x(62), 62**2]], [-log(.95), -log(.85)])
//     -> [8.76298148e-04, 3.05914916e-05]
TEST(Temperature, CanFallOrRiseAtBothEnds) {
  const std::string effect = "  temperature: {coefficient: 8.76298148e-04, quadratic: 3.05914916e-05}\n";
  EXPECT_NEAR(1 / warm(effect, -40), 0.95, 1e-4);
  EXPECT_NEAR(1 / warm(effect, 85), 0.85, 1e-4);
}

TEST(Temperature, FollowsTheGasWithItsLag) {
  SensorChain chain(straightRig("  temperature: {coefficient: 0.003, lag: 60}\n"));
  std::vector<double> times, logs;
  for (std::uint64_t second = 0; second < 200; ++second) {
    fsr::simulation::RigSample sample{double(second), 310e3, second, second == 0 ? 23.0 : 33.0};
    const double rise = chain.read(sample)[0] / (0.5 * kStraightCounts) - 1;
    if (second < 2 || second > 120) continue;
    times.push_back(double(second));
    logs.push_back(std::log(1 - rise / (warm("  temperature: {coefficient: 0.003}\n", 33) - 1)));
  }
  EXPECT_NEAR(-1 / fitLine(times, logs).slope, 60, 1);
}

TEST(Temperature, IsNominalAtItsReference) {
  const std::string effect = "  temperature: {coefficient: 0.003, reference: 30}\n";
  EXPECT_EQ(warm(effect, 30), 1);
  EXPECT_NEAR(warm(effect, 31) - 1, 0.003, 0.01 * 0.003 + kCount * 2);
  EXPECT_LT(warm(effect, 23), 1 - 0.02);
}

TEST(Temperature, ShiftsTheZeroLikeALoad) {
  const std::string effect = "  temperature: {coefficient: 0, zero_shift: 500}\n";
  EXPECT_NEAR((warm(effect, 33) - 1) * 310e3, 5e3, 2 * kCount * kStraightSpan);
  SensorChain chain(straightRig(effect));
  EXPECT_EQ(chain.read({0, 0, 0, 33})[0], std::lround(5e3 / kStraightSpan * kStraightCounts));
}

/// Time constant [s] with which the reading at 310 kPa approaches its last value after the gas has warmed
/// from 23 to `gas` within the first second.
double lagOf(const std::string& effect, double gas) {
  SensorChain chain(straightRig(effect));
  std::vector<double> readings, times, logs;
  for (std::uint64_t second = 0; second < 1000; ++second)
    readings.push_back(chain.read({double(second), 310e3, second, second == 0 ? 23.0 : gas})[0]);
  for (std::size_t second = 2; second < 50; ++second) {
    times.push_back(double(second));
    logs.push_back(std::log(std::abs(readings[second] - readings.back())));
  }
  return -1 / fitLine(times, logs).slope;
}

TEST(Temperature, ShiftsTheZeroWithALagOfItsOwn) {
  EXPECT_NEAR(lagOf("  temperature: {coefficient: 0, zero_shift: 1000, lag: 100, zero_lag: 20}\n", 33), 20,
              0.5);
  EXPECT_NEAR(lagOf("  temperature: {coefficient: 0.01, lag: 100, zero_lag: 20}\n", 33), 100, 5);
}

TEST(Temperature, StartsAboveTheGasAndApproachesIt) {
  SensorChain chain(straightRig("  temperature: {coefficient: 0.01, start: 10, lag: 50}\n"));
  EXPECT_NEAR(chain.read({0, 310e3, 0, 23})[0] / (0.5 * kStraightCounts),
              warm("  temperature: {coefficient: 0.01}\n", 33), 2 * kCount);
  EXPECT_NEAR(lagOf("  temperature: {coefficient: 0.01, start: 10, lag: 50}\n", 23), 50, 2);
}

TEST(BreakIn, FadesOverTheFirstCyclesAndComesBackWithEachMount) {
  SensorChain chain(straightRig("  break_in: {change: -0.04, cycles: 2}\n"));
  const fsr::simulation::PressureProfile cycles =
      fsr::simulation::pressureProfile({620e3, 62e3, 62e3, 0, 0, 4});
  for (const std::uint32_t mount : {1u, 2u}) {
    chain.mount(test_support::surfaceOf({}, mount));
    const auto readings = readAlong(chain, cycles, 0.1);
    double before = 0;
    for (int cycle = 0; cycle < 4; ++cycle) {
      const double missing = 1 - share(readingAt(readings, 20.0 * cycle + 10));
      EXPECT_NEAR(missing, 0.04 * std::exp(-(cycle + 0.5) / 2), 3 * kCount);
      if (cycle > 0) {
        EXPECT_NEAR(missing / before, std::exp(-0.5), 0.005);
      }
      before = missing;
    }
  }
}

TEST(Wear, TakesItsShareInTenMillionCyclesAndHardlyAnyInSixty) {
  const auto cycles = fsr::simulation::pressureProfile({620e3, 620e3, 620e3, 0, 0, 61});
  const auto fresh = along("  wear: {loss: 0.07}\n", cycles, 0.1);
  const auto old = along("  wear: {loss: 0.07, age: 1e7}\n", cycles, 0.1);
  EXPECT_NEAR(share(readingAt(old, 1)), 0.93, 1e-3);
  const double lost = share(readingAt(fresh, 1)) - share(readingAt(fresh, 121));
  EXPECT_GT(lost, 5e-4);
  EXPECT_LT(lost, 3e-3);
}

TEST(Wear, ThatFadesComesToItsLossAfterSomeCycles) {
  const auto cycles = fsr::simulation::pressureProfile({620e3, 620e3, 620e3, 0, 0, 40});
  const auto readings = along("  wear: {loss: 0.2, exponent: 1, fading: 3}\n", cycles, 0.1);
  for (const int cycle : {0, 1, 5, 39}) {
    const double expected = 1 - 0.2 * -std::expm1(-(cycle + 0.5) / 3);
    EXPECT_NEAR(share(readingAt(readings, 2.0 * cycle + 1)), expected, 2 * kCount) << cycle;
  }
}

// A triangular cycle to 620 kPa within 73 s has the impulse of 73 s at 310 kPa.
TEST(Wear, ByImpulseGoesOnWhileThePressureIsHeld) {
  const std::string fading = "  wear: {loss: 0.2, exponent: 1, fading: 3";
  const auto hold = profile({{0, 310e3}, {730, 310e3}});
  const auto by_impulse = along(fading + ", impulse_share: 1, cycle_duration: 73}\n", hold, 1);
  for (const int cycle : {0, 1, 2, 10}) {
    const double expected = 1 - 0.2 * -std::expm1(-cycle / 3.0);
    EXPECT_NEAR(share(readingAt(by_impulse, 73.0 * cycle)) / 0.5, expected, 4 * kCount) << cycle;
  }
  EXPECT_EQ(along(fading + "}\n", hold, 1).back().counts, 0.5 * kStraightCounts);  // by path length
}

TEST(Wear, OfACycleIsTheSameByPathLengthAndByImpulse) {
  const auto cycles = fsr::simulation::pressureProfile({620e3, 17e3, 17e3, 0, 0, 3});
  const auto lost = [&](const std::string& form) {
    return along("  wear: {loss: 0.2, exponent: 1, fading: 3, cycle_duration: " + std::to_string(kCycle) +
                     ", impulse_share: " + form + "}\n",
                 cycles, 0.01);
  };
  const auto path = lost("0"), both = lost("0.5"), impulse = lost("1");
  for (const double cycle : {1.5, 2.5}) {  // the peaks, where half of the cycle is over in each form
    EXPECT_NEAR(readingAt(impulse, cycle * kCycle).counts, readingAt(path, cycle * kCycle).counts, 5);
    EXPECT_NEAR(readingAt(both, cycle * kCycle).counts, readingAt(path, cycle * kCycle).counts, 5);
  }
}

TEST(Drift, MovesByItsShareAnHourAndEndsWhereItIsTold) {
  const auto hold = profile({{0, 310e3}, {7200, 310e3}});
  const auto endless = along("  drift: {rate_per_hour: 0.02}\n", hold, 10);
  const auto ending = along("  drift: {rate_per_hour: 0.02, time_constant: 600}\n", hold, 10);
  const double start = endless.front().counts;
  EXPECT_NEAR(readingAt(endless, 3600).counts / start, 1.02, 1e-4);
  EXPECT_NEAR(readingAt(endless, 7200).counts / start, 1.04, 1e-4);
  EXPECT_NEAR(readingAt(ending, 7200).counts / start, 1 + 0.02 * 600 / 3600, 1e-4);
  const auto zero =
      along("  drift: {rate_per_hour: 0, zero_per_hour: 600}\n", profile({{0, 0}, {7200, 0}}), 10);
  EXPECT_EQ(readingAt(zero, 3600).counts, 600);
}

// The steps of a walk over 10 s, and of one that is pulled back within 60 s.
TEST(Drift, WalksByItsStepAndIsPulledBackWithinItsTimeConstant) {
  constexpr double kStep = 6000, kPeriod = 10, kFades = 60;  // [counts/sqrt(h)], [s], [s]
  const auto course = profile({{0, 310e3}, {20000, 310e3}});
  const auto countsOf = [&](const std::string& more) {
    std::vector<double> counts;
    for (const auto& reading :
         along("  drift: {rate_per_hour: 0, zero_walk: 6000" + more + "}\n", course, kPeriod))
      counts.push_back(reading.counts);
    return counts;
  };
  const auto stepsOf = [&](const std::string& more) {
    const std::vector<double> counts = countsOf(more);
    std::vector<double> steps;
    for (std::size_t i = 1; i < counts.size(); ++i) steps.push_back(counts[i] - counts[i - 1]);
    return steps;
  };
  const double endless = kStep * std::sqrt(kPeriod / 3600);
  EXPECT_NEAR(test_support::deviation(stepsOf("")), endless, 0.06 * endless);
  const double fading = kStep * std::sqrt(kFades / 3600 * (1 - std::exp(-kPeriod / kFades)));
  EXPECT_NEAR(test_support::deviation(stepsOf(", time_constant: 60")), fading, 0.06 * fading);
  const double level = kStep * std::sqrt(kFades / 2 / 3600);  // where the walk is pulled back as it goes
  EXPECT_NEAR(test_support::deviation(countsOf(", time_constant: 60")), level, 0.15 * level);
  EXPECT_EQ(test_support::deviation(stepsOf(", only_surfaces: [elsewhere]")), 0);
}

}  // namespace
