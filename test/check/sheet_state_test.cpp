#include "check/sheet_life.h"

#include <gtest/gtest.h>

#include <cmath>

#include "check/life_rig.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "support/holds.h"

namespace fsr::check {
namespace {

using test_support::lineThrough;

dataset::Recording oneWeek(double gain = 1) {
  test_support::LifeRig rig;
  rig.weeks = 1;
  rig.gain = [gain](std::size_t) { return gain; };
  return weeklyRecordings(rig).at(0);
}

TEST(SheetState, ReadsTheGainAgainstTheFirstCalibration) {
  const dataset::Recording before = oneWeek(), after = oneWeek(0.9);
  const calibration::Calibration first = lineThrough(before);
  const SheetState state = stateOf(after, &first);
  ASSERT_EQ(state.surfaces.size(), 1u);
  EXPECT_EQ(state.surfaces[0].surface, "flat");
  EXPECT_NEAR(stateOf(before, &first).surfaces[0].gain, 1, 0.001);
  EXPECT_NEAR(state.surfaces[0].gain, 0.9, 0.001);
  EXPECT_LT(state.surfaces[0].gain_scatter, 0.002);
  // A calibration of the later readings tells the same.
  EXPECT_NEAR(stateOf(lineThrough(after), &first).surfaces[0].gain, 0.9, 0.002);
  EXPECT_NEAR(stateOf(first, &first).surfaces[0].gain, 1, 1e-6);
}

TEST(SheetState, ReadsZeroAndNoiseAtRest) {
  dataset::Recording recording = oneWeek();
  for (std::uint16_t& count : recording.counts) count = static_cast<std::uint16_t>(count / 2 + 400);
  const SheetState state = stateOf(recording, nullptr);
  // Half of the noise of 30 counts. Readings below zero do not exist, so some mounts read less noise.
  EXPECT_LE(state.surfaces[0].noise, 17);
  EXPECT_GT(state.surfaces[0].noise, 5);
  EXPECT_GE(state.surfaces[0].zero, 400);
  EXPECT_LT(state.surfaces[0].zero, 500);
  EXPECT_TRUE(std::isnan(state.surfaces[0].gain)) << "no calibration";
}

TEST(SheetState, KnowsNoGainOnASurfaceThatTheFirstCalibrationLacks) {
  dataset::Recording recording = oneWeek();
  const calibration::Calibration first = lineThrough(recording);
  recording.conditions[0].curvature = {{20, 0, 0}};
  EXPECT_TRUE(std::isnan(stateOf(recording, &first).surfaces[0].gain));
  EXPECT_FALSE(std::isnan(stateOf(recording, &first).surfaces[0].zero));
}

TEST(SheetState, TellsOnlyOfTaxelsWithoutAChamber) {
  dataset::Recording recording = oneWeek();
  recording.pressure.clear();
  EXPECT_TRUE(stateOf(recording, nullptr).surfaces.empty());
}

TEST(SheetState, RefusesAnotherConverter) {
  dataset::Recording recording = oneWeek();
  const calibration::Calibration first = lineThrough(recording);
  recording.full_scale = 4095;
  EXPECT_TRUE(test_support::holds(test_support::refusal([&] { stateOf(recording, &first); }),
                                  {"4095 counts", "65535 counts"}));
}

TEST(SheetState, IsCalledByTheSerialNumber) {
  EXPECT_EQ(sheetOf({"sheet-a", "0042", "", "", "", ""}), "0042");
  EXPECT_EQ(sheetOf({"sheet-a", "", "", "", "", ""}), "sheet-a");
}

TEST(SheetState, ReadsDates) {
  EXPECT_EQ(dayText(dateOf("2026-03-01T23:59:59Z")), "2026-03-01");
  EXPECT_EQ(dateOf("1970-01-02T00:00:01Z"), 86401'000'000'000);
  EXPECT_THROW(dateOf("yesterday"), settings::InputError);
}

}  // namespace
}  // namespace fsr::check
