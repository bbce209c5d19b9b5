// Effects of load, timing, wires and converter, and faults, measured from the counts.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "fsr_pressure_map/settings/input_error.h"
#include "simulation/pressure_profile.h"
#include "simulation/rig.h"
#include "simulation/sensitivity.h"
#include "support/simulated_rig.h"

namespace {

using fsr::settings::InputError;
using fsr::simulation::LoadPattern;
using fsr::simulation::SensorChain;
using test_support::cylinder;
using test_support::deviation;
using test_support::fitLine;
using test_support::kStraightCounts;
using test_support::kStraightSpan;
using test_support::profile;
using test_support::readAlong;
using test_support::Reading;
using test_support::readingAt;
using test_support::straightRig;
using test_support::surfaceOf;

/// Counts of a whole scan at one pressure.
std::vector<double> scanAt(SensorChain& chain, double pressure, double time = 0) {
  const auto& counts = chain.read({time, pressure, 0});
  return {counts.begin(), counts.end()};
}
std::vector<double> scanAt(const std::string& effect, double pressure, int rows, int columns) {
  SensorChain chain(straightRig(effect, rows, columns));
  return scanAt(chain, pressure);
}

// --- load --------------------------------------------------------------------------------------------

TEST(TurnOn, ReadsNothingBelowItsPressureUntilBendingClosesTheGap) {
  SensorChain chain(straightRig("  turn_on: {pressure: 10e3, curvature_constant: 10}\n"));
  EXPECT_EQ(scanAt(chain, 9.9e3)[0], 0);
  EXPECT_NEAR(scanAt(chain, 72e3)[0], 6000, 1);  // 62 kPa of 620 are left
  chain.mount(cylinder(0.05));
  EXPECT_NEAR(scanAt(chain, 62e3)[0], 6000 * (62 - 10 * std::exp(-2)) / 62, 1);
}

TEST(EdgeStiffness, ActsOnTaxelsNearTheEdge) {
  const auto counts = scanAt("  edge_stiffness: {change: -0.05, length: 0.01}\n", 310e3, 9, 9);
  const auto lost = [&](int row, int column) { return 1 - counts[row * 9 + column] / 30000; };
  EXPECT_NEAR(lost(0, 4), 0.05 * std::exp(-0.5), 1e-4);  // half a pitch from the edge
  EXPECT_NEAR(lost(4, 7), 0.05 * std::exp(-1.5), 1e-4);
  EXPECT_NEAR(lost(4, 4), 0.05 * std::exp(-4.5), 1e-4);
}

TEST(Repositioning, MovesEachMountByItsOwnSmoothField) {
  SensorChain chain(straightRig("  repositioning: {offset: 0, gain: 0.02, length: 0.04}\n", 20, 20));
  std::vector<double> all, neighbours;
  for (std::uint32_t mount = 1; mount <= 40; ++mount) {
    chain.mount(surfaceOf({}, mount));
    const auto counts = scanAt(chain, 310e3);
    for (std::size_t i = 0; i < counts.size(); ++i) all.push_back(counts[i] / 30000 - 1);
    for (std::size_t i = 1; i < 20; ++i) neighbours.push_back((counts[i] - counts[i - 1]) / 30000);
  }
  EXPECT_NEAR(deviation(all), 0.02, 0.004);  // 400 taxels of 0.2 m hold some 25 independent patches a mount
  // Neighbours 10 mm apart differ by sqrt(2 (1 - exp(-(0.01 / 0.04)^2 / 2))) of it.
  EXPECT_NEAR(deviation(neighbours), 0.02 * 0.248, 0.0015);
  chain.mount(surfaceOf({}, 7));
  const auto seventh = scanAt(chain, 310e3);
  chain.mount(surfaceOf({}, 8));
  EXPECT_NE(scanAt(chain, 310e3), seventh);
  chain.mount(surfaceOf({}, 7));
  EXPECT_EQ(scanAt(chain, 310e3), seventh);
}

TEST(Repositioning, ShiftsAnUnevenLoad) {
  SensorChain chain(straightRig("  repositioning: {offset: 0, gain: 0, shift: 0.01}\n", 9, 9));
  std::vector<double> centres;
  for (std::uint32_t mount = 1; mount <= 60; ++mount) {
    chain.mount(surfaceOf({}, mount), {LoadPattern::Kind::kDisc, {0, 0}, 0.01, 0});
    const auto counts = scanAt(chain, 310e3);
    double sum = 0, sample = 0;
    for (int i = 0; i < 81; ++i) {
      sum += counts[i];
      sample += counts[i] * (i % 9 - 4) * 0.01;
    }
    centres.push_back(sample / sum);
  }
  EXPECT_NEAR(deviation(centres), 0.01, 0.003);
}

TEST(LoadPattern, LoadsADiscOrWhatLiesBesideAnEdge) {
  const fsr::matrix::Layout layout{{7, 10}, 0.01, 0.01};
  const auto total = [&](const LoadPattern& pattern) {
    double sum = 0;
    for (const double share : fsr::simulation::loadShares(pattern, layout)) sum += share * 1e-4;
    return sum;
  };
  EXPECT_NEAR(total({}), 0.007, 1e-15);
  EXPECT_NEAR(total({LoadPattern::Kind::kDisc, {0.003, -0.002}, 0.02, 0}), M_PI * 4e-4, 1e-5);
  EXPECT_NEAR(total({LoadPattern::Kind::kEdge, {0.01, 0}, 0, 0}), 0.04 * 0.07, 1e-9);
  const auto upper = fsr::simulation::loadShares({LoadPattern::Kind::kEdge, {0, 0.005}, 0, M_PI / 2}, layout);
  EXPECT_EQ(upper[0], 0);
  EXPECT_EQ(upper[69], 1);
}

// --- timing ------------------------------------------------------------------------------------------

// 0.1 s at 17 kPa/s is 0.27 % of 620 kPa.
TEST(TimeSkew, ReadsEarlierPressuresThanItsStampsSay) {
  const auto course = fsr::simulation::pressureProfile({620e3, 17e3, 17e3, 5, 5, 1});
  SensorChain late(straightRig("  time_skew: {delay: 0.1}\n")), right(straightRig());
  const auto shifted = readAlong(late, course, 0.1), straight = readAlong(right, course, 0.1);
  const auto difference = [&](double time) {
    return (readingAt(shifted, time).counts - double(readingAt(straight, time).counts)) / kStraightCounts;
  };
  EXPECT_NEAR(difference(20), -0.00274, 2e-5);
  EXPECT_NEAR(difference(60), 0.00274, 2e-5);
  EXPECT_EQ(difference(2), 0);
  EXPECT_EQ(difference(43), 0);
}

TEST(ScanSkew, ReadsTaxelAfterTaxelRoundTheStamp) {
  const auto course = profile({{0, 0}, {620, 620e3}});  // 1 kPa/s, 96.8 counts a second
  std::vector<double> index, counts;
  for (std::size_t taxel = 0; taxel < 70; ++taxel) {
    SensorChain chain(straightRig("  scan_skew: {taxel_time: 1e-2}\n", 7, 10));
    const auto readings = readAlong(chain, course, 10, taxel);
    index.push_back(double(taxel));
    counts.push_back(readingAt(readings, 300).counts);
  }
  const auto line = fitLine(index, counts);
  EXPECT_NEAR(line.slope, 1e-2 * kStraightCounts / 620, 0.01);
  EXPECT_NEAR(line.intercept + 34.5 * line.slope, 300.0 / 620 * kStraightCounts, 1);
}

// 1 kPa/s: after t seconds the scan shows the pressure of (1 + e) t.
TEST(TimeSkew, WithARateReadsAheadOfItsStampsInProportionToTheTimeSinceTheFirstScan) {
  SensorChain slow(straightRig("  time_skew: {delay: 0, rate: 1e-2}\n")),
      fast(straightRig("  time_skew: {delay: 0, rate: -1e-2}\n"));
  const auto course = profile({{0, 0}, {620, 620e3}});
  const auto ahead = readAlong(slow, course, 1), behind = readAlong(fast, course, 1);
  EXPECT_EQ(ahead.front().counts, 0);
  for (const double time : {10.0, 100.0, 600.0}) {
    EXPECT_NEAR(readingAt(ahead, time).counts, 1.01 * time / 620 * kStraightCounts, 1) << time;
    EXPECT_NEAR(readingAt(behind, time).counts, 0.99 * time / 620 * kStraightCounts, 1) << time;
  }
}

TEST(TimeSkew, CountsTheRateFromTheFirstScanAndAddsItToTheDelay) {
  SensorChain chain(straightRig("  time_skew: {delay: 2, rate: 1e-2}\n"));
  const fsr::simulation::PressureCourse course = [](double time) { return 1e3 * (time - 1000); };
  for (const double elapsed : {0.0, 100.0, 300.0}) {
    const double expected = (200 + 1.01 * elapsed - 2) / 620 * kStraightCounts;
    const double time = 1200 + elapsed;
    EXPECT_NEAR(chain.read({time, course(time), 0, 23, &course})[0], expected, 1) << elapsed;
  }
}

TEST(TimeSkew, NeedsTheCourseOfThePressure) {
  SensorChain chain(straightRig("  time_skew: {delay: 0.1}\n"));
  EXPECT_THROW(chain.read({0, 100e3, 0}), std::invalid_argument);
}

// --- wires and converter -----------------------------------------------------------------------------

// The straight rig conducts 60000 / (65535 * 3600) = 0.2543 mS at 620 kPa: 0.2 mS at 487.6 kPa.
constexpr double kFifthOfAMilliSiemens = 0.2e-3 * 65535 * 3600 / kStraightCounts * kStraightSpan;

TEST(Crosstalk, TakesOnePerCentWithFiveOhmAndTenTaxels) {
  const auto without = scanAt("", kFifthOfAMilliSiemens, 1, 10);
  const auto with =
      scanAt("  crosstalk: {row_resistance: 5, column_resistance: 0}\n", kFifthOfAMilliSiemens, 1, 10);
  for (int i = 0; i < 10; ++i) EXPECT_NEAR(with[i] / without[i], 1 / 1.01, 5e-5);
}

TEST(Crosstalk, ShowsWhereNeighboursOnTheSameWiresAreLoaded) {
  const std::string effect = "  crosstalk: {row_resistance: 50, column_resistance: 20}\n";
  SensorChain without(straightRig("", 7, 10)), with(straightRig(effect, 7, 10));
  const LoadPattern right_half{LoadPattern::Kind::kEdge, {0.0, 0}, 0, 0};
  without.mount(surfaceOf({}), right_half);
  with.mount(surfaceOf({}), right_half);
  const auto all = scanAt(effect, kFifthOfAMilliSiemens, 7, 10);
  const auto half = scanAt(with, kFifthOfAMilliSiemens), clean = scanAt(without, kFifthOfAMilliSiemens);
  EXPECT_EQ(half[0], 0);
  EXPECT_NEAR(half[9] / clean[9], 1 / (1 + 50 * 5 * 0.2e-3 + 20 * 7 * 0.2e-3), 1e-4);
  EXPECT_NEAR(all[9] / clean[9], 1 / (1 + 50 * 10 * 0.2e-3 + 20 * 7 * 0.2e-3), 1e-4);
}

TEST(SupplyDroop, SinksAllTaxelsWithTheTotalLoad) {
  const auto without = scanAt("", kFifthOfAMilliSiemens, 7, 10);
  const auto with = scanAt("  supply_droop: {resistance: 0.3}\n", kFifthOfAMilliSiemens, 7, 10);
  EXPECT_NEAR(with[33] / without[33], 1 - 0.3 * 70 * 0.2e-3, 5e-5);
}

TEST(Saturation, LimitsSmoothlyOrHard) {
  SensorChain soft(straightRig("  saturation: {level: 40000, sharpness: 8}\n"));
  SensorChain hard(straightRig("  saturation: {level: 40000, sharpness: .inf}\n"));
  double before = -1;
  for (double pressure = 0; pressure <= 793e3; pressure += 10e3) {
    const double now = scanAt(soft, pressure)[0], ideal = pressure / kStraightSpan * kStraightCounts;
    EXPECT_GT(now, before);
    EXPECT_LT(now, 40000);
    EXPECT_NEAR(scanAt(hard, pressure)[0], std::min(ideal, 40000.0), 0.51);
    before = now;
  }
  EXPECT_NEAR(scanAt(soft, 40000 / kStraightCounts * kStraightSpan)[0], 40000 / std::pow(2, 1.0 / 8), 1);
}

/// Amplitude of the counts' oscillation at a frequency, over whole periods.
double amplitudeAt(const std::vector<Reading>& readings, double frequency) {
  double sine = 0, cosine = 0;
  for (const Reading& reading : readings) {
    sine += reading.counts * std::sin(2 * M_PI * frequency * reading.time);
    cosine += reading.counts * std::cos(2 * M_PI * frequency * reading.time);
  }
  return 2 * std::hypot(sine, cosine) / double(readings.size());
}

TEST(MainsPickup, BeatsAtTheDistanceFromTheNextMultipleOfTheScanRate) {
  SensorChain chain(straightRig("  mains_pickup: {amplitude: 80, frequency: 50.05}\n"));
  const auto readings = readAlong(chain, profile({{0, 310e3}, {199.95, 310e3}}), 0.1);
  EXPECT_NEAR(amplitudeAt(readings, 0.05), 80, 0.2);
  EXPECT_NEAR(amplitudeAt(readings, 0.1), 0, 0.2);
}

TEST(MainsPickup, StandsStillAsAPatternOverTheRowsAtAMultipleOfTheScanRate) {
  SensorChain chain(straightRig("  mains_pickup: {amplitude: 80, frequency: 50, taxel_time: 1e-3}\n", 7, 10));
  const auto first = scanAt(chain, 310e3, 0);
  for (int scan = 1; scan < 100; ++scan) EXPECT_EQ(scanAt(chain, 310e3, 0.1 * scan), first);
  for (std::size_t i = 0; i + 20 < first.size(); ++i) EXPECT_NEAR(first[i], first[i + 20], 1);  // 20 ms
  EXPECT_GT(deviation(first), 50);
}

// --- faults ------------------------------------------------------------------------------------------

// Counts of 600 taxels at 310 kPa, less those without the effect, at each time [s].
std::vector<std::vector<double>> offsets(const std::string& effect, const std::vector<double>& times) {
  SensorChain chain(straightRig(effect, 20, 30));
  std::vector<std::vector<double>> result;
  for (const double time : times) {
    result.push_back(scanAt(chain, 310e3, time));
    for (double& count : result.back()) count -= 0.5 * kStraightCounts;
  }
  return result;
}

double correlation(const std::vector<double>& a, const std::vector<double>& b) {
  double covariance = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    covariance += (a[i] - test_support::mean(a)) * (b[i] - test_support::mean(b)) / double(a.size());
  return covariance / (deviation(a) * deviation(b));
}

TEST(SessionOffset, BelongsToTheTaxelAndTheSession) {
  const auto sessions = offsets("  session_offset: {offset: 100, pause: 10}\n", {0, 1, 5, 15, 16, 600});
  EXPECT_EQ(sessions[1], sessions[0]);
  EXPECT_EQ(sessions[2], sessions[0]);
  EXPECT_EQ(sessions[4], sessions[3]);  // a session begins after 10 s without a scan
  for (const std::size_t session : {0u, 3u, 5u}) {
    EXPECT_NEAR(test_support::mean(sessions[session]), 0, 5 * 100 / std::sqrt(600.0));
    EXPECT_NEAR(deviation(sessions[session]), 100, 5 * 100 / std::sqrt(1200.0));
  }
  EXPECT_NEAR(correlation(sessions[0], sessions[3]), 0, 5 / std::sqrt(600.0));
  EXPECT_NEAR(correlation(sessions[3], sessions[5]), 0, 5 / std::sqrt(600.0));
}

TEST(SessionOffset, IsTheSameAtAnyLoadAndAfterMountingAgain) {
  SensorChain chain(straightRig("  session_offset: {offset: 100}\n", 2, 3));
  const auto low = scanAt(chain, 155e3, 0);
  chain.mount(cylinder(0.07, 2));
  const auto high = scanAt(chain, 310e3, 1);
  for (std::size_t i = 0; i < low.size(); ++i) EXPECT_NEAR(high[i] - low[i], 0.25 * kStraightCounts, 1);
}

TEST(DeadTaxel, ReadsNothingFromItsStartOn) {
  SensorChain chain(straightRig("  dead_taxel: {taxels: 3, first: 8, start: 100}\n", 7, 10));
  const auto before = scanAt(chain, 310e3, 99);
  EXPECT_EQ(std::count(before.begin(), before.end(), 0), 0);
  const auto counts = scanAt(chain, 310e3, 100);
  EXPECT_EQ(counts[8], 0);
  EXPECT_EQ(std::count(counts.begin(), counts.end(), 0), 3);
}

TEST(StuckTaxel, ReadsAlwaysTheSame) {
  SensorChain chain(straightRig("  stuck_taxel: {first: 2, value: 777}\n", 1, 4));
  EXPECT_EQ(scanAt(chain, 0)[2], 777);
  EXPECT_EQ(scanAt(chain, 500e3)[2], 777);
  SensorChain later(straightRig("  stuck_taxel: {first: 2, value: -1, start: 5}\n", 1, 4));
  EXPECT_EQ(scanAt(later, 62e3, 4)[2], 6000);
  EXPECT_EQ(scanAt(later, 310e3, 5)[2], 30000);
  EXPECT_EQ(scanAt(later, 62e3, 6)[2], 30000);
}

// Taxel 2 fails twice, taxel 0 from 5 s on.
TEST(Faults, HaveSpellsOfSingleTaxels) {
  SensorChain dead(straightRig("  dead_taxel: {spells: [2, 1, 2, 0, 2, 4, 6, 0, 0, 5, 1e9, 0]}\n", 1, 4));
  std::string silent;
  for (int time = 0; time < 8; ++time) {
    const auto counts = scanAt(dead, 310e3, time);
    for (std::size_t t = 0; t < counts.size(); ++t) silent += counts[t] == 0 ? std::to_string(t) : "";
    silent += '|';
  }
  EXPECT_EQ(silent, "|2|2||2|02|02|0|");
  SensorChain stuck(straightRig("  stuck_taxel: {spells: [2, 1, 2, 777, 1, 2, 3, -1]}\n", 1, 4));
  EXPECT_EQ(scanAt(stuck, 62e3, 0)[2], 6000);
  EXPECT_EQ(scanAt(stuck, 62e3, 1)[2], 777);
  EXPECT_EQ(scanAt(stuck, 310e3, 2)[1], 30000);
  EXPECT_EQ(scanAt(stuck, 62e3, 3)[1], 30000);
  EXPECT_EQ(scanAt(stuck, 62e3, 4)[1], 6000);
}

// Columns 0 and 2 fail one after the other.
TEST(Faults, HaveSpellsOfLines) {
  SensorChain chain(straightRig("  column_fault: {spells: [0, 1, 2, 0.25, 2, 2, 3, 1]}\n", 1, 4));
  for (const auto& [time, first, third] : std::vector<std::array<int, 3>>{
           {0, 6000, 6000}, {1, 4500, 6000}, {2, 4500, 0}, {3, 6000, 0}, {4, 6000, 6000}}) {
    const auto counts = scanAt(chain, 62e3, time);
    EXPECT_EQ(counts[0], first) << time;
    EXPECT_EQ(counts[1], 6000) << time;
    EXPECT_EQ(counts[2], third) << time;
  }
}

TEST(Faults, OfTaxelsThatTheMatrixDoesNotHaveAreRefused) {
  for (const char* effect : {"dead_taxel: {first: 4}", "dead_taxel: {taxels: 5}",
                             "stuck_taxel: {taxels: 1.5}", "row_fault: {line: 1}"}) {
    EXPECT_THROW(SensorChain(straightRig(std::string("  ") + effect + "\n", 1, 4)), InputError) << effect;
  }
}

/// Share of scans in which each taxel reads less than half of what it should.
std::vector<double> shareLost(const std::string& effect) {
  SensorChain chain(straightRig(effect, 3, 4));
  std::vector<double> lost(12);
  for (int scan = 0; scan < 20000; ++scan) {
    const auto counts = scanAt(chain, 310e3, 0.1 * scan);
    for (std::size_t i = 0; i < lost.size(); ++i) lost[i] += counts[i] < 15000 ? 1.0 / 20000 : 0;
  }
  return lost;
}

TEST(LineFaults, TakeAWholeRowOrColumnForTheirShareOfTheTime) {
  const auto row = shareLost("  row_fault: {share: 0.1, line: 1, burst: 0.5}\n");
  const auto column = shareLost("  column_fault: {share: 0.1, line: 2, burst: 0.5}\n");
  for (std::size_t i = 0; i < 12; ++i) {
    // 4,000 pieces of 0.5 s: five standard errors are 5 sqrt(0.1 * 0.9 / 4000) = 0.024.
    EXPECT_NEAR(row[i], i / 4 == 1 ? 0.1 : 0, 0.024) << i;
    EXPECT_NEAR(column[i], i % 4 == 2 ? 0.1 : 0, 0.024) << i;
  }
}

// --- reference ---------------------------------------------------------------------------------------

TEST(TransducerError, BowsByAQuarterPerCentOfItsSpan) {
  const fsr::simulation::ReferenceChannel reference(straightRig("  transducer_error: {bow: 0.0025}\n"));
  const fsr::simulation::Transducer transducer;
  double largest = 0;  // what the recording says above the truth [Pa]
  for (double pressure = 0; pressure <= 793e3; pressure += 1e3) {
    largest = std::max(largest, transducer.gaugePressure(reference.counts(pressure)) - pressure);
  }
  EXPECT_NEAR(largest, 0.0025 * 1137e3, transducer.step() / 2);
}

TEST(TransducerError, CanBeTakenBack) {
  const fsr::simulation::ReferenceChannel reference(
      straightRig("  transducer_error: {offset: 3e3, gain: -0.02, bow: 0.005}\n"));
  for (const double pressure : {0.0, 50e3, 620e3}) {
    EXPECT_NEAR(reference.truePressure(reference.indicated(pressure)), pressure, 1e-6);
  }
}

TEST(TransducerError, IsAnErrorOfTheReadingsAtTheRecordedPressure) {
  fsr::simulation::Sensitivity sensitivity(straightRig(), "transducer_error", "gain");
  // A gauge that shows 1 % too much at 310 kPa belongs to readings of 1 % less.
  EXPECT_NEAR(sensitivity.read({0, 310e3, 0}).reading[0], -0.5 * kStraightCounts, 0.01);
}

}  // namespace
