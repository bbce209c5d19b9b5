// Hum of the mains whose beat with the scans has the period of a cycle, or that comes with the load.
#include <gtest/gtest.h>

#include "fsr_pressure_map/discrepancy/discrepancy.h"
#include "planted.h"

namespace fsr::discrepancy {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kCycle = 40;          // of the first program of kTwoSpeeds and of the only one [s]
constexpr double kTaxelTime = 0.3e-3;  // from one taxel of a scan to the next [s]

using Ids = std::vector<std::string>;
using Count = double (*)(const planted::Changed& now, double phase);

// `beat`: apparent frequency of the hum [Hz].
DiscrepancyReport found(double beat, Count count) {
  std::string rig = planted::kOneSurface;
  const std::string small = "{rows: 3, columns: 4}";
  rig.replace(rig.find(small), small.size(), "{rows: 7, columns: 10}");
  return investigate(planted::problemReading(rig, [&](const planted::Changed& now) {
    return count(now, 2 * kPi * (beat * now.time + 50 * kTaxelTime * static_cast<double>(now.taxel)));
  }));
}

void expectHum(const DiscrepancyReport& report) {
  EXPECT_EQ(report.verdict, Verdict::kNamed) << report.sentence;
  EXPECT_EQ(report.credible_set, std::vector<Ids>{{"mains_pickup"}}) << report.sentence;
}

TEST(Hum, IsNamedWhereItsBeatHasThePeriodOfACycle) {
  expectHum(found(1 / kCycle, [](const planted::Changed& now, double phase) {
    return now.count + 16 * std::sin(phase);
  }));
}

TEST(Hum, OfARectifierThatCouplesIntoRowsUnequallyIsNamedInTheSamePeriod) {
  expectHum(found(1 / kCycle, [](const planted::Changed& now, double phase) {
    const double row = 0.5 + static_cast<double>(now.taxel / 10 * 3 % 7) / 6;
    return now.count + 16 * row * (std::sin(phase) + 0.5 * std::sin(3 * phase));
  }));
}

TEST(Hum, IsNamedWhereItGrowsWithTheReading) {
  expectHum(found(0.13, [](const planted::Changed& now, double phase) {
    return now.count * (1 + 0.02 * std::sin(phase));
  }));
}

TEST(Hum, IsNamedWhereItComesWithHalfOfTheLoad) {
  expectHum(found(0.13, [](const planted::Changed& now, double phase) {
    return now.count + 40 / (1 + std::exp((1200 - now.count) / 100)) * std::sin(phase);
  }));
}

void expectNoHum(const DiscrepancyReport& report) {
  for (const Ids& ids : report.credible_set)
    EXPECT_EQ(std::count(ids.begin(), ids.end(), "mains_pickup"), 0) << report.sentence;
}

// A pattern of rows, of columns or of any taxels stands in the period of a cycle without any hum.
TEST(Hum, IsNotALoopOfSomeRows) {
  std::string rows;
  for (const int row : {0, 2, 4, 6}) {
    for (int column = 0; column < 10; ++column) rows += std::to_string(10 * row + column) + ", ";
  }
  std::string rig = planted::kOneSurface;
  const std::string small = "{rows: 3, columns: 4}";
  rig.replace(rig.find(small), small.size(), "{rows: 7, columns: 10}");
  expectNoHum(
      investigate(planted::problem(rig, "  hysteresis: {loop_width: 0.08, only_taxels: [" + rows + "]}\n")));
}

TEST(Hum, IsNotALoopWhoseWidthDiffersFromTaxelToTaxel) {
  expectNoHum(found(0, [](const planted::Changed& now, double) {
    const double any = std::fmod(1000 * std::sin(1 + static_cast<double>(now.taxel)), 1);  // -1 .. 1
    const double width = 0.04 * (0.6 + 0.8 * any) * (1 - now.count / 4096);
    const bool filling = std::fmod(now.loads, 1) < 0.5;
    return now.count * (filling ? 1 - width : 1 + width);
  }));
}

}  // namespace
}  // namespace fsr::discrepancy
