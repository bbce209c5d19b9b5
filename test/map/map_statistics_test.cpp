#include "fsr_pressure_map/map/map_statistics.h"

#include <gtest/gtest.h>

#include <cmath>

#include "fsr_pressure_map/settings/input_error.h"

namespace fsr::map {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr double kThreshold = 10e3;  // [Pa]

// 2 x 3 taxels, 10 mm x 20 mm each. By hand, contact from 10 kPa on:
//
//      20   50    -      kPa    contact: 20, 50, 30, 100 -> 4 x 2e-4 m^2 = 8e-4 m^2
//       5   30  100             force: 200e3 Pa x 2e-4 m^2 = 40 N; mean 50 kPa
PressureMap handMap() {
  PressureMap map;
  map.reset({{2, 3}, 0.010, 0.020});
  map.state = MapState::kOk;
  map.pressure = {20e3f, 50e3f, kNaN, 5e3f, 30e3f, 100e3f};
  return map;
}

std::vector<double> flatAreas() {
  return std::vector<double>(6, 2e-4);
}

RegionStatistics whole(const PressureMap& map) {
  return regionStatistics(map, {}, flatAreas(), kThreshold);
}

TEST(MapStatistics, AgreeWithACalculationByHand) {
  const RegionStatistics s = whole(handMap());
  EXPECT_DOUBLE_EQ(s.peak, 100e3);
  EXPECT_EQ(s.peak_taxel.value, 5u);
  EXPECT_NEAR(s.mean, 50e3, 1e-6);
  EXPECT_NEAR(s.standard_deviation, std::sqrt((900.0 + 0 + 400 + 2500) / 4) * 1e3, 1e-6);
  EXPECT_NEAR(s.contact_area, 8e-4, 1e-15);
  EXPECT_NEAR(s.total_area, 12e-4, 1e-15);
  EXPECT_NEAR(s.force, 40.0, 1e-9);
  EXPECT_EQ(s.bad, 1u);
  EXPECT_EQ(s.at_least, 0u);
  // x: (-10 x 20 + 0 x 50 + 0 x 30 + 10 x 100) / 200 = 4 mm; y: (-10 x 70 + 10 x 130) / 200 = 3 mm
  ASSERT_TRUE(s.centre);
  EXPECT_NEAR(s.centre->x, 0.004, 1e-12);
  EXPECT_NEAR(s.centre->y, 0.003, 1e-12);
}

TEST(MapStatistics, WeighTaxelsByTheAreaOfTheBentSheet) {
  std::vector<double> areas = flatAreas();
  areas[5] = 1e-4;  // the 100 kPa
  const RegionStatistics s = regionStatistics(handMap(), {}, areas, kThreshold);
  EXPECT_NEAR(s.force, 100e3 * 2e-4 + 100e3 * 1e-4, 1e-9);  // 20 N + 10 N
  EXPECT_NEAR(s.contact_area, 7e-4, 1e-15);
  EXPECT_NEAR(s.mean, 30.0 / 7e-4, 1e-6);
}

TEST(MapStatistics, UseOnlyTheTaxelsOfTheRegion) {
  Region left{"left", {1, 0, 0, 1, 0, 0}, {}};
  const RegionStatistics s = regionStatistics(handMap(), left, flatAreas(), kThreshold);
  EXPECT_EQ(s.region, "left");
  EXPECT_DOUBLE_EQ(s.peak, 20e3);
  EXPECT_NEAR(s.force, 4.0, 1e-12);  // 5 kPa is below the contact threshold
  EXPECT_NEAR(s.total_area, 4e-4, 1e-15);
}

TEST(MapStatistics, IgnoreMaskedTaxelsAndCountSaturatedOnes) {
  PressureMap map = handMap();
  map.flags[2] = taxel_flag::kMasked;
  map.flags[5] = taxel_flag::kSaturated;
  const RegionStatistics s = whole(map);
  EXPECT_EQ(s.bad, 0u);
  EXPECT_EQ(s.at_least, 1u);
  EXPECT_NEAR(s.total_area, 10e-4, 1e-15);
}

TEST(MapStatistics, CountTaxelsWhosePressureIsAtLeastTheirReading) {
  using namespace taxel_flag;
  PressureMap map = handMap();
  map.flags[0] = kReadingExtrapolated;                // above training
  map.flags[1] = kReadingExtrapolated | kBelowRange;  // below training: "less than"
  map.flags[4] = kSaturated | kReadingExtrapolated;
  map.flags[5] = kCurvatureExtrapolated;
  EXPECT_EQ(whole(map).at_least, 2u);
  EXPECT_EQ(sumOfSheets("limb", {whole(map), whole(map)}).at_least, 4u);
}

TEST(MapStatistics, AreTheSameWhileTheHistoryIsNotSettled) {
  PressureMap map = handMap();
  for (std::uint16_t& flags : map.flags) flags = taxel_flag::kHistoryShort;
  const RegionStatistics settled = whole(handMap()), s = whole(map);
  EXPECT_EQ(s.peak, settled.peak);
  EXPECT_EQ(s.force, settled.force);
  EXPECT_EQ(s.contact_area, settled.contact_area);
  EXPECT_EQ(s.bad, settled.bad);
  EXPECT_EQ(s.at_least, 0u);
}

TEST(PressureMap, KnowsWhichPartOfItsReadingsIsNotSettled) {
  using namespace taxel_flag;
  PressureMap map = handMap();  // five readings: taxel 2 has none
  EXPECT_EQ(unsettledShare(map.pressure, map.flags), 0);
  map.flags = {kHistoryShort, kHistoryShort, kHistoryShort, kTared, kSaturated, 0};
  EXPECT_DOUBLE_EQ(unsettledShare(map.pressure, map.flags), 2.0 / 5);
  map.flags = {kHistoryShort, kHistoryShort | kSaturated, kDead | kHistoryShort, kMasked, kStuck, kLineFault};
  EXPECT_DOUBLE_EQ(unsettledShare(map.pressure, map.flags), 1);
  map.pressure.assign(6, kNaN);
  EXPECT_EQ(unsettledShare(map.pressure, map.flags), 0);
  EXPECT_EQ(unsettledShare({}, {}), 0);
}

TEST(MapStatistics, ExcludeATaxelBelowItsTurnOnFromTheContact) {
  PressureMap map = handMap();
  map.flags[0] = taxel_flag::kBelowRange;
  EXPECT_NEAR(whole(map).force, 36.0, 1e-9);
}

TEST(MapStatistics, AreNanWithoutAReading) {
  PressureMap map = handMap();
  map.pressure.assign(6, kNaN);
  const RegionStatistics s = whole(map);
  EXPECT_TRUE(std::isnan(s.peak));
  EXPECT_TRUE(std::isnan(s.force));
  EXPECT_TRUE(std::isnan(s.mean));
  EXPECT_FALSE(s.centre);
  EXPECT_EQ(s.bad, 6u);
}

TEST(MapStatistics, HaveZeroForceAndNoMeanWithoutContact) {
  PressureMap map = handMap();
  map.pressure.assign(6, 1e3f);
  const RegionStatistics s = whole(map);
  EXPECT_EQ(s.force, 0.0);
  EXPECT_EQ(s.contact_area, 0.0);
  EXPECT_TRUE(std::isnan(s.mean));
  EXPECT_FALSE(s.centre);
}

TEST(MapStatistics, RefuseAMaskOfAnotherMatrix) {
  EXPECT_THROW(regionStatistics(handMap(), {"x", {1, 0}, {}}, flatAreas(), kThreshold), settings::InputError);
}

// Taxel 0 at 10, 20, 40 kPa after 0, 1, 1.5 s: 15 + 15 = 30 kPa s; taxel 1 always at 16 kPa: 24 kPa s.
TEST(PressureIntegral, IsTheLargestOfTheTaxels) {
  PressureIntegral integral(1.0);
  PressureMap map;
  map.reset({{1, 2}, 0.01, 0.01});
  const std::pair<double, float> steps[] = {{100.0, 10e3f}, {101.0, 20e3f}, {101.5, 40e3f}};
  for (const auto& [time, pressure] : steps) {
    map.pressure = {pressure, 16e3f};
    integral.add(time, map);
  }
  EXPECT_NEAR(integral.largest({}), 30e3, 1e-6);
  EXPECT_NEAR(integral.largest({"b", {0, 1}, {}}), 24e3, 1e-6);
  EXPECT_NEAR(integral.duration(), 1.5, 1e-12);
}

TEST(PressureIntegral, SkipsGapsAndRestartsWhenTimeRunsBackwards) {
  PressureIntegral integral(1.0);
  PressureMap map;
  map.reset({{1, 1}, 0.01, 0.01});
  map.pressure = {10e3f};
  integral.add(0, map);
  integral.add(1, map);
  integral.add(5, map);
  EXPECT_NEAR(integral.largest({}), 10e3, 1e-9);
  EXPECT_NEAR(integral.duration(), 1, 1e-12);
  integral.add(2, map);
  EXPECT_EQ(integral.duration(), 0);
  EXPECT_EQ(integral.largest({}), 0);
}

// Two sheets: 40 N on 8e-4 m^2 (mean 50 kPa) and 10 N on 2e-4 m^2 at an even 50 kPa: 50 N on 1e-3 m^2.
TEST(SumOfSheets, AddsAreasAndForces) {
  const RegionStatistics a = whole(handMap());
  RegionStatistics b;
  b.peak = b.mean = 50e3;
  b.standard_deviation = 0;
  b.contact_area = 2e-4;
  b.total_area = 3e-4;
  b.force = 10;
  b.bad = 2;
  b.alarm = AlarmState::kOk;
  const RegionStatistics sum = sumOfSheets("limb", {a, b});
  EXPECT_EQ(sum.region, "limb");
  EXPECT_NEAR(sum.force, 50, 1e-9);
  EXPECT_NEAR(sum.contact_area, 10e-4, 1e-15);
  EXPECT_NEAR(sum.total_area, 15e-4, 1e-15);
  EXPECT_NEAR(sum.mean, 50e3, 1e-6);
  EXPECT_NEAR(sum.standard_deviation, std::sqrt(950e6 * 8 / 10), 1e-3);
  EXPECT_DOUBLE_EQ(sum.peak, 100e3);
  EXPECT_EQ(sum.bad, 3u);
  EXPECT_FALSE(sum.centre);
  EXPECT_EQ(sum.alarm, AlarmState::kUnknown);  // of the first sheet
}

TEST(MapStatistics, UpdateRegionsIntegralsAndAlarmsOverTime) {
  MapStatistics statistics({{"", {}, {90e3, 0.5, 0}}, {"left", {1, 0, 0, 1, 0, 0}, {}}}, kThreshold);
  PressureMap map = handMap();
  map.flags[2] = taxel_flag::kMasked;
  statistics.update(10.0, map, flatAreas());
  const auto& now = statistics.update(10.6, map, flatAreas());
  ASSERT_EQ(now.size(), 2u);
  EXPECT_EQ(now[0].alarm, AlarmState::kAlarm);
  EXPECT_EQ(now[1].alarm, AlarmState::kNotSet);
  EXPECT_NEAR(now[1].pressure_time_integral, 0.6 * 20e3, 1e-3);
  for (const RegionStatistics& region : statistics.stale()) {
    EXPECT_EQ(region.alarm, region.region.empty() ? AlarmState::kUnknown : AlarmState::kNotSet);
    EXPECT_TRUE(std::isnan(region.peak));
  }
  EXPECT_FALSE(statistics.setAlarm("right", {10e3, 0, 0}));
  ASSERT_TRUE(statistics.setAlarm("left", {10e3, 0, 0}));
  EXPECT_EQ(statistics.update(11.0, map, flatAreas())[1].alarm, AlarmState::kAlarm);
}

}  // namespace
}  // namespace fsr::map
