#include "check/sheet_life.h"

#include <gtest/gtest.h>

#include <cmath>

#include "check/life_rig.h"
#include "fsr_pressure_map/settings/input_error.h"

namespace fsr::check {
namespace {

using test_support::LifeRig;

// The life of a simulated sheet, with a calibration of its first week.
SheetLife lifeOfRig(const LifeRig& rig, double level = 0.01) {
  const std::vector<dataset::Recording> recordings = test_support::weeklyRecordings(rig);
  const calibration::Calibration first = test_support::lineThrough(recordings.front());
  std::vector<SheetState> states;
  for (const dataset::Recording& recording : recordings) states.push_back(stateOf(recording, &first));
  LifeOptions options;
  options.level = level;
  return lifeOf(states, "first.h5", options);
}

// Weeks at which a column changed.
std::vector<std::size_t> changes(const SheetLife& life, const std::string& name) {
  std::vector<std::size_t> weeks;
  for (const Column& column : life.columns) {
    if (column.name != name) continue;
    for (std::size_t i = 0; i < column.rows.size(); ++i)
      if (column.tests.steps[i].changed) weeks.push_back(column.rows[i]);
  }
  return weeks;
}

TEST(SheetLife, FindsALossOfTenPercentInTheWeekOfIt) {
  int found = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    LifeRig rig;
    rig.seed = seed;
    rig.weeks = 12;
    rig.gain = [](std::size_t week) { return week < 9 ? 1.0 : 0.9; };
    const std::vector<std::size_t> weeks = changes(lifeOfRig(rig, 0.05), "gain");
    found += !weeks.empty() && weeks.front() == 9;
  }
  EXPECT_GE(found, 6) << "of 10 sheets; mounts scatter by 2 %";
}

TEST(SheetLife, CallsSlowWearNoChange) {
  int dates = 0, flagged = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    LifeRig rig;
    rig.seed = seed;
    rig.gain = [](std::size_t week) { return 1 - 0.01 * static_cast<double>(week); };
    const SheetLife life = lifeOfRig(rig, 0.05);
    for (const Column& column : life.columns) {
      if (column.name != "gain") continue;
      EXPECT_LT(column.values.back(), 0.97);
      dates += static_cast<int>(column.tested());
    }
    flagged += static_cast<int>(changes(life, "gain").size());
  }
  EXPECT_EQ(dates, 70);
  // Level 0.05 / 3 columns: 1.2 of 70 are expected; more than 6 have a probability of 0.0003 (binomial).
  EXPECT_LE(flagged, 6);
}

TEST(SheetLife, FindsNothingMoreOftenThanItsLevelWhereNothingChanged) {
  constexpr double kLevel = 0.1;
  int dates = 0, flagged = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    LifeRig rig;
    rig.seed = seed;
    const SheetLife life = lifeOfRig(rig, kLevel);
    EXPECT_TRUE(life.lost.empty());
    std::vector<bool> at(life.rows.size(), false);
    for (const Column& column : life.columns) {
      for (std::size_t i = 0; i < column.rows.size(); ++i)
        if (column.tests.steps[i].changed) at[column.rows[i]] = true;
    }
    for (std::size_t week = 3; week < at.size(); ++week) {
      ++dates;
      flagged += at[week];
    }
  }
  EXPECT_EQ(dates, 140);
  // At most 14 are expected; more than 25 have a probability of 0.001.
  EXPECT_LE(flagged, 25);
}

TEST(SheetLife, NamesATaxelThatDies) {
  LifeRig rig;
  rig.dead_taxel = 6;
  rig.dead_from = 5;
  const SheetLife life = lifeOfRig(rig);
  ASSERT_EQ(life.lost.size(), 1u);
  EXPECT_EQ(life.lost[0].row, 5u);
  EXPECT_EQ(life.lost[0].taxel, 6u);
  EXPECT_FALSE(life.lost[0].stuck);
  EXPECT_TRUE(life.changed());
  EXPECT_EQ(life.rows[9].dead, std::vector<std::size_t>{6});
}

TEST(SheetLife, SaysThatThreeDatesAreTooFew) {
  LifeRig rig;
  rig.weeks = 3;
  const SheetLife life = lifeOfRig(rig);
  EXPECT_FALSE(life.changed());
  for (const Column& column : life.columns) {
    EXPECT_EQ(column.tested(), 0u);
    EXPECT_EQ(column.tests.steps[2].untested, kTooFew);
  }
}

SheetState state(const std::string& file, int day, const std::string& surface, double gain) {
  SheetState state;
  state.file = file;
  state.sheet = "0042";
  state.date_ns = day * 86'400'000'000'000LL + 3'600'000'000'000LL;
  state.layout = {{2, 3}, 0.01, 0.01};
  state.full_scale = 4095;
  state.surfaces = {{surface, gain, 0.01, 10, 1}};
  return state;
}

TEST(SheetLife, TakesTheSurfaceOfMostDatesAndTheMeanOfADay) {
  const SheetLife life = lifeOf({state("c", 9, "bent", 0.5), state("a", 1, "flat", 1.0),
                                 state("b", 1, "flat", 1.2), state("d", 9, "flat", 1.0)},
                                "first.h5");
  EXPECT_EQ(life.surface, "flat");
  ASSERT_EQ(life.rows.size(), 2u);
  EXPECT_DOUBLE_EQ(life.rows[0].gain, 1.1);
  EXPECT_EQ(life.rows[0].files, (std::vector<std::string>{"a", "b"}));
  EXPECT_DOUBLE_EQ(life.rows[1].gain, 1.0);
  LifeOptions bent;
  bent.surface = "bent";
  EXPECT_TRUE(
      std::isnan(lifeOf({state("c", 9, "bent", 0.5), state("a", 1, "flat", 1.0)}, "", bent).rows[0].gain));
  bent.surface = "round";
  EXPECT_THROW(lifeOf({state("a", 1, "flat", 1.0)}, "", bent), settings::InputError);
}

}  // namespace
}  // namespace fsr::check
