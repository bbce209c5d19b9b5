#include "fsr_pressure_map/map/region.h"

#include <gtest/gtest.h>

#include <cmath>

#include "fsr_pressure_map/map/pressure_map.h"

namespace fsr::map {
namespace {

const AlarmOptions kOptions{100e3, 2.0, 10e3};  // [Pa, s, Pa]

AlarmEvidence sure(double pressure) {
  return {pressure, true, NAN};
}

TEST(Alarm, IsRaisedOnlyAfterTheDwellTime) {
  Alarm alarm(kOptions);
  EXPECT_EQ(alarm.update(0, sure(120e3)), AlarmState::kOk);
  EXPECT_EQ(alarm.update(1.9, sure(120e3)), AlarmState::kOk);
  EXPECT_EQ(alarm.update(2.0, sure(120e3)), AlarmState::kAlarm);
}

TEST(Alarm, RestartsTheDwellTimeAfterADip) {
  Alarm alarm(kOptions);
  alarm.update(0, sure(120e3));
  alarm.update(1.9, sure(99e3));
  alarm.update(2.0, sure(120e3));
  EXPECT_EQ(alarm.update(3.9, sure(120e3)), AlarmState::kOk);
  EXPECT_EQ(alarm.update(4.0, sure(120e3)), AlarmState::kAlarm);
}

TEST(Alarm, EndsOnlyBelowTheHysteresis) {
  Alarm alarm(kOptions);
  alarm.update(0, sure(100e3));
  EXPECT_EQ(alarm.update(2, sure(100e3)), AlarmState::kAlarm);
  EXPECT_EQ(alarm.update(3, sure(90e3)), AlarmState::kAlarm);
  EXPECT_EQ(alarm.update(4, sure(89e3)), AlarmState::kOk);
  EXPECT_EQ(alarm.update(5, sure(95e3)), AlarmState::kOk);
}

TEST(Alarm, IsUnknownAndNeverOkWhereTheMapCannotAnswer) {
  Alarm alarm(kOptions);
  EXPECT_EQ(alarm.update(0, {20e3, false, NAN}), AlarmState::kUnknown);
  EXPECT_EQ(alarm.update(1, {NAN, false, NAN}), AlarmState::kUnknown);
  EXPECT_EQ(alarm.stale(), AlarmState::kUnknown);
}

TEST(Alarm, IsRaisedByACertainPressureWhateverTheOtherTaxelsShow) {
  Alarm alarm(kOptions);
  alarm.update(0, {120e3, false, NAN});
  EXPECT_EQ(alarm.update(2, {120e3, false, NAN}), AlarmState::kAlarm);
  EXPECT_EQ(alarm.update(3, {20e3, false, NAN}),
            AlarmState::kUnknown);  // the pressure elsewhere may be above
}

TEST(Alarm, RestartsTheDwellTimeWhenTimeRunsBackwards) {
  Alarm alarm(kOptions);
  alarm.update(100, sure(120e3));
  EXPECT_EQ(alarm.update(1, sure(120e3)), AlarmState::kOk);
  EXPECT_EQ(alarm.update(3, sure(120e3)), AlarmState::kAlarm);
}

TEST(Alarm, IsNeverOkWithoutAThreshold) {
  Alarm alarm;
  EXPECT_EQ(alarm.update(0, sure(500e3)), AlarmState::kNotSet);
  EXPECT_EQ(alarm.update(1, {500e3, false, NAN}), AlarmState::kNotSet);
  EXPECT_EQ(alarm.stale(), AlarmState::kNotSet);
}

PressureMap soundMap() {
  PressureMap map;
  map.reset({{1, 3}, 0.01, 0.01});
  map.state = MapState::kOk;
  map.pressure = {10e3f, 20e3f, 30e3f};
  return map;
}

TEST(Alarm, StaysWhenThePressureGoesOnRisingBeyondTraining) {
  Alarm alarm({300e3, 0, 20e3});
  PressureMap map;
  map.reset({{1, 3}, 0.01, 0.01});
  map.state = MapState::kOk;
  map.pressure = {10e3f, 20e3f, 402e3f};
  EXPECT_EQ(alarm.update(0, evidence(map, {})), AlarmState::kAlarm);
  map.pressure[2] = 500e3f;  // the highest of training, at a chamber pressure of 700 kPa
  map.flags[2] = taxel_flag::kReadingExtrapolated;
  EXPECT_EQ(alarm.update(1, evidence(map, {})), AlarmState::kAlarm);
}

TEST(AlarmEvidence, OfAReadingAboveTrainingIsAtLeastThatReading) {
  using namespace taxel_flag;
  PressureMap map;
  map.reset({{1, 2}, 0.01, 0.01});
  map.state = MapState::kOk;
  map.pressure = {10e3f, 500e3f};
  map.flags[1] = kReadingExtrapolated;
  EXPECT_DOUBLE_EQ(evidence(map, {}).sure, 500e3);
  EXPECT_FALSE(evidence(map, {}).whole);  // the pressure may be above any threshold
  // A curvature or temperature beyond training may hide a lower pressure.
  for (const std::uint16_t flag : {kCurvatureExtrapolated, kTemperatureExtrapolated, kFilled}) {
    map.flags[1] = static_cast<std::uint16_t>(kReadingExtrapolated | flag);
    EXPECT_DOUBLE_EQ(evidence(map, {}).sure, 10e3) << flag;
    EXPECT_FALSE(evidence(map, {}).whole) << flag;
  }
}

TEST(AlarmEvidence, OfAValidMapIsItsPeak) {
  const AlarmEvidence e = evidence(soundMap(), {});
  EXPECT_DOUBLE_EQ(e.sure, 30e3);
  EXPECT_TRUE(e.whole);
}

TEST(AlarmEvidence, IsNotWholeInAnyStateButOk) {
  for (int state = 1; state <= 5; ++state) {
    PressureMap map = soundMap();
    map.state = static_cast<MapState>(state);
    EXPECT_FALSE(evidence(map, {}).whole) << state;
  }
}

TEST(AlarmEvidence, IsNotWholeWithAFlagThatHidesPressure) {
  using namespace taxel_flag;
  for (const std::uint16_t flag : {kSaturated, kDead, kStuck, kReadingExtrapolated, kCurvatureExtrapolated,
                                   kLineFault, kTemperatureExtrapolated, kFilled}) {
    PressureMap map = soundMap();
    map.flags[2] = flag;
    EXPECT_FALSE(evidence(map, {}).whole) << flag;
    EXPECT_DOUBLE_EQ(evidence(map, {}).sure,
                     (flag == kSaturated || flag == kReadingExtrapolated) ? 30e3 : 20e3)
        << flag;
  }
  for (const std::uint16_t flag : {kTared, kBetweenClasses, kBelowRange, kHistoryShort}) {
    PressureMap map = soundMap();
    map.flags[2] = flag;
    EXPECT_TRUE(evidence(map, {}).whole) << flag;
  }
}

// After a start every taxel has the flag: an alarm then counts as at any other time.
TEST(Alarm, IsRaisedAndEndsWhileTheHistoryIsNotSettled) {
  Alarm alarm({100e3, 0, 10e3});
  PressureMap map = soundMap();
  map.flags.assign(3, taxel_flag::kHistoryShort);
  EXPECT_EQ(alarm.update(0, evidence(map, {})), AlarmState::kOk);
  map.pressure[1] = 120e3f;
  EXPECT_EQ(alarm.update(1, evidence(map, {})), AlarmState::kAlarm);
  map.pressure[1] = 20e3f;
  EXPECT_EQ(alarm.update(2, evidence(map, {})), AlarmState::kOk);
}

TEST(AlarmEvidence, OfAReadingBelowTrainingIsLessThanThatReading) {
  PressureMap map = soundMap();
  map.flags[2] = taxel_flag::kBelowRange | taxel_flag::kReadingExtrapolated;
  const AlarmEvidence e = evidence(map, {});
  EXPECT_TRUE(e.whole);
  EXPECT_DOUBLE_EQ(e.sure, 20e3);
  EXPECT_DOUBLE_EQ(e.less_than, 30e3);
}

TEST(Alarm, IsUnknownWhereLessThanMayStillBeAboveTheThreshold) {
  Alarm alarm(kOptions);
  EXPECT_EQ(alarm.update(0, {20e3, true, 99e3}), AlarmState::kOk);
  EXPECT_EQ(alarm.update(1, {20e3, true, 100e3}), AlarmState::kUnknown);
  EXPECT_EQ(alarm.update(9, {20e3, true, 100e3}), AlarmState::kUnknown);  // but no alarm
}

TEST(Alarm, EndsWhereEveryTaxelIsBelowItsRange) {
  Alarm alarm({100e3, 0, 10e3});
  EXPECT_EQ(alarm.update(0, sure(120e3)), AlarmState::kAlarm);
  EXPECT_EQ(alarm.update(1, {NAN, true, 95e3}), AlarmState::kAlarm);
  EXPECT_EQ(alarm.update(2, {NAN, true, 1e3}), AlarmState::kOk);
}

TEST(AlarmEvidence, IgnoresMaskedTaxelsAndThoseOutsideTheRegion) {
  PressureMap map = soundMap();
  map.pressure[2] = NAN;
  map.flags[2] = taxel_flag::kMasked;
  EXPECT_TRUE(evidence(map, {}).whole);
  map.flags[2] = taxel_flag::kDead;
  EXPECT_TRUE(evidence(map, {"left", {1, 1, 0}, {}}).whole);
  EXPECT_FALSE(evidence(map, {}).whole);
  EXPECT_FALSE(evidence(map, {"none", {0, 0, 0}, {}}).whole);
}

}  // namespace
}  // namespace fsr::map
