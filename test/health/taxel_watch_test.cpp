#include "fsr_pressure_map/health/taxel_watch.h"

#include <gtest/gtest.h>

#include <functional>
#include <random>

#include "support/allocation_guard.h"

namespace fsr::health {
namespace {

constexpr matrix::MatrixSize kSize{7, 10};
constexpr std::uint16_t kFullScale = 4095;
constexpr double kRate = 10.0;  // scans a second
constexpr std::size_t kTaxels = 70;

/// A sheet under uniform load that follows `level` [codes]. Single taxels can be set to other codes.
class Sheet {
 public:
  explicit Sheet(const TaxelWatchOptions& options = {}) : watch(kSize, kFullScale, options) {}

  void run(double seconds, const std::function<double(double)>& level) {
    for (const double end = time + seconds; time < end; time += 1 / kRate) {
      std::vector<std::uint16_t> counts(kTaxels, code(level(time)));
      for (const auto& [taxel, value] : overruled) counts[taxel] = value;
      watch.observe(counts.data(), time);
    }
  }

  std::uint16_t code(double level) {
    const double noisy = level + noise(random);
    return static_cast<std::uint16_t>(std::min(std::max(noisy, 0.0), double{kFullScale}));
  }

  TaxelWatch watch;
  std::vector<std::pair<std::size_t, std::uint16_t>> overruled;
  double time = 1000.0;
  std::mt19937 random{1};
  std::normal_distribution<double> noise{0.0, 1.0};
};

double cycles(double time) {
  return 2000.0 * (1 - std::cos(2 * M_PI * time / 40.0)) / 2;
}
double constantLoad(double) {
  return 2000.0;
}
double noLoad(double) {
  return 0.0;
}

constexpr double kTwoWindows = 25.0;  // [s], at any phase of the first
constexpr double kCycle = 60.0;       // [s], more than one load cycle and a window

int flagged(const TaxelWatch& watch) {
  int result = 0;
  for (const auto flag : watch.flags()) result += flag != 0;
  return result;
}

// A taxel without contact reads the noise of the board: up to 10 counts where its deviation is 3.
TEST(TaxelWatch, FindsADeadTaxelOnANoisyBoardOnceItKnowsTheNoise) {
  for (const bool known : {false, true}) {
    Sheet sheet;
    if (known) sheet.watch.setNoise(3);
    std::normal_distribution<double> board(0, 3);
    for (int scan = 0; scan < 10 * kCycle; ++scan, sheet.time += 1 / kRate) {
      std::vector<std::uint16_t> counts(kTaxels);
      for (auto& one : counts) one = sheet.code(cycles(sheet.time) + board(sheet.random));
      counts[23] = sheet.code(board(sheet.random));
      sheet.watch.observe(counts.data(), sheet.time);
    }
    EXPECT_EQ(flagged(sheet.watch), known ? 1 : 0);
    EXPECT_EQ(sheet.watch.flags()[23] != 0, known);
  }
}

TEST(TaxelWatch, FindsAWholeDeadRowAndColumn) {
  Sheet sheet;
  for (std::size_t column = 0; column < 10; ++column) sheet.overruled.push_back({column, 0});
  for (std::size_t row = 2; row < 7; ++row) sheet.overruled.push_back({row * 10 + 5, 0});
  sheet.run(kTwoWindows, constantLoad);
  for (const auto& [taxel, value] : sheet.overruled) {
    EXPECT_EQ(sheet.watch.flags()[taxel] & ~map::taxel_flag::kLineFault, map::taxel_flag::kDead)
        << "taxel " << taxel;
  }
}

TEST(TaxelWatch, FindsAStuckRowAndSingleStuckTaxelsAtTheBorder) {
  Sheet sheet;
  for (std::size_t column = 0; column < 10; ++column) sheet.overruled.push_back({column, 812});
  sheet.overruled.insert(sheet.overruled.end(), {{39, 812}, {60, 812}, {65, 812}});
  sheet.run(kCycle, cycles);
  for (const auto& [taxel, value] : sheet.overruled) {
    const int line = taxel < 10 ? map::taxel_flag::kLineFault : 0;
    EXPECT_EQ(sheet.watch.flags()[taxel], map::taxel_flag::kStuck | line) << "taxel " << taxel;
  }
  EXPECT_EQ(flagged(sheet.watch), 13);
}

TEST(TaxelWatch, CountsATaxelThatBecomesAliveAgain) {
  Sheet sheet;
  sheet.overruled = {{47, 812}, {33, 0}};
  sheet.run(kCycle, cycles);
  ASSERT_EQ(flagged(sheet.watch), 2);
  sheet.overruled.clear();
  sheet.run(kCycle, cycles);
  EXPECT_EQ(flagged(sheet.watch), 0);
  EXPECT_EQ(sheet.watch.revivals(), 2u);
}

TEST(TaxelWatch, RaisesNothingInHoursOfNormalUse) {
  Sheet sheet;
  for (int i = 0; i < 60; ++i) {
    sheet.run(kCycle, cycles);
    sheet.run(kCycle, noLoad);
    sheet.run(kCycle, constantLoad);
    ASSERT_EQ(flagged(sheet.watch), 0) << "after round " << i;
  }
  EXPECT_EQ(sheet.watch.revivals(), 0u);  // nor was a taxel flagged in between
}

TEST(TaxelWatch, RaisesNothingForASmallLoadedPatch) {
  Sheet sheet;  // four taxels loaded, all others at rest: no taxel has a majority of loaded neighbours
  sheet.overruled = {{33, 3000}, {34, 3000}, {43, 3000}, {44, 3000}};
  sheet.run(kTwoWindows, noLoad);
  EXPECT_EQ(flagged(sheet.watch), 0);
}

TEST(TaxelWatch, DoesNotCallATaxelThatSaturatesUnderLoadStuck) {
  Sheet sheet;
  sheet.overruled = {{47, kFullScale}};
  sheet.run(kTwoWindows, constantLoad);
  EXPECT_EQ(flagged(sheet.watch), 0);
}

// A fault that all taxels of a row or column show is a fault of its wire.
TEST(TaxelWatch, FindsABrokenRowAsALineFault) {
  Sheet sheet;
  for (std::size_t column = 0; column < 10; ++column) sheet.overruled.push_back({30 + column, 0});
  sheet.run(kTwoWindows, constantLoad);
  for (std::size_t taxel = 0; taxel < kTaxels; ++taxel) {
    EXPECT_EQ(sheet.watch.flags()[taxel],
              taxel / 10 == 3 ? map::taxel_flag::kDead | map::taxel_flag::kLineFault : 0);
  }
  sheet.overruled.clear();
  sheet.run(kCycle, cycles);
  EXPECT_EQ(flagged(sheet.watch), 0) << "repaired";
}

TEST(TaxelWatch, FindsAShortedTaxelWhenLoadComesOrGoes) {
  Sheet sheet;
  sheet.overruled = {{47, kFullScale}};
  sheet.run(kTwoWindows, noLoad);
  EXPECT_EQ(flagged(sheet.watch), 0) << "a point load reads the same";
  sheet.run(kCycle, cycles);
  EXPECT_EQ(sheet.watch.flags()[47], map::taxel_flag::kStuck);
  EXPECT_EQ(flagged(sheet.watch), 1);
}

TEST(TaxelWatch, DoesNotCallAProminenceAmongLoadedNeighboursStuck) {
  Sheet sheet;  // a standing person shifts their weight: 15 to 60 % of full scale around the place
  sheet.overruled = {{47, kFullScale}};
  sheet.run(600, [](double time) { return 1535 + 920 * std::sin(time / 3); });
  EXPECT_EQ(flagged(sheet.watch), 0);
}

TEST(TaxelWatch, RaisesNothingForATaxelThatLeavesFullScaleInBetween) {
  Sheet sheet;
  sheet.overruled = {{47, kFullScale}};
  sheet.run(kTwoWindows, constantLoad);
  sheet.overruled = {{47, kFullScale - 1}};
  sheet.run(kTwoWindows, constantLoad);
  sheet.overruled = {{47, kFullScale}};
  sheet.run(kTwoWindows, noLoad);
  EXPECT_EQ(flagged(sheet.watch), 0);
}

TEST(TaxelWatch, FindsAShortedColumnAtRest) {
  Sheet sheet;
  for (std::size_t row = 0; row < 7; ++row) sheet.overruled.push_back({row * 10 + 2, kFullScale});
  sheet.run(kTwoWindows, noLoad);
  for (std::size_t row = 0; row < 7; ++row) {
    EXPECT_EQ(sheet.watch.flags()[row * 10 + 2], map::taxel_flag::kStuck | map::taxel_flag::kLineFault)
        << row;
  }
  EXPECT_EQ(flagged(sheet.watch), 7);
}

TEST(TaxelWatch, ReportsAChangeOfALineOnce) {
  Sheet sheet;
  for (std::size_t column = 0; column < 10; ++column) sheet.overruled.push_back({column, 0});
  sheet.run(100.0, constantLoad);
  int changes = 0;
  for (int i = 0; i < 500; ++i) {
    std::vector<std::uint16_t> counts(kTaxels, 2000);
    for (std::size_t column = 0; column < 10; ++column) counts[column] = 0;
    changes += sheet.watch.observe(counts.data(), sheet.time += 0.1);
  }
  EXPECT_LE(changes, 5) << "at most once a window";
}

TEST(TaxelWatch, KeepsAVerdictWithoutEvidenceAgainstIt) {
  Sheet sheet;
  sheet.overruled = {{33, 0}};
  sheet.run(kCycle, cycles);
  sheet.run(kCycle, noLoad);
  EXPECT_EQ(sheet.watch.flags()[33], map::taxel_flag::kDead);
}

TEST(TaxelWatch, RestartsItsWindowWhenTimeRunsBackwards) {
  Sheet sheet;
  sheet.overruled = {{33, 0}};
  sheet.run(9.0, constantLoad);
  sheet.time -= 500.0;
  sheet.run(9.5, constantLoad);
  EXPECT_EQ(flagged(sheet.watch), 0);  // both parts are shorter than a window
  sheet.run(10.0, constantLoad);
  EXPECT_EQ(flagged(sheet.watch), 1);
}

TEST(TaxelWatch, NeedsEnoughScansForAVerdict) {
  TaxelWatchOptions options;
  options.least_scans = 400;
  Sheet sheet(options);
  sheet.overruled = {{33, 0}};
  sheet.run(39.0, constantLoad);
  EXPECT_EQ(flagged(sheet.watch), 0);
}

TEST(TaxelWatch, GivesNoVerdictForATaxelWithoutNeighbours) {
  TaxelWatch watch({1, 1}, kFullScale);
  const std::uint16_t stuck = 500;
  for (int i = 0; i < 500; ++i) EXPECT_FALSE(watch.observe(&stuck, i * 0.1));
}

TEST(TaxelWatch, AllocatesNothingForAScan) {
  Sheet sheet;
  const std::vector<std::uint16_t> counts(kTaxels, 7);
  const test_support::AllocationGuard guard;
  for (int i = 0; i < 1000; ++i) sheet.watch.observe(counts.data(), i * 0.1);
  EXPECT_EQ(guard.allocations(), 0u);
}

}  // namespace
}  // namespace fsr::health
