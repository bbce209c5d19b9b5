#include "check/socket_check.h"

#include <gtest/gtest.h>

#include <cmath>

#include "fsr_pressure_map/settings/input_error.h"
#include "support/small_tables.h"

namespace fsr::check {
namespace {

constexpr std::size_t kTaxels = 12;
constexpr double kRate = 20;  // [Hz]

/// 10 s of rest, 60 s of steps at about 1 Hz, 10 s of rest: 3 x 4 taxels, 12 bit.
dataset::Recording worn(double rest_after = 40) {
  dataset::Recording recording;
  recording.name = "socket.bag";
  recording.layout.size = {3, 4};
  recording.full_scale = 4095;
  recording.conditions = {matrix::Surface{"socket", 1, {matrix::Curvature{}}, {}}};
  for (int i = 0; i < 80 * kRate; ++i) {
    const double time = i / kRate;
    const bool on = time > 10 && time < 70;
    const double load = on ? 800 + 600 * std::sin(6.2 * time) : time >= 70 ? rest_after : 40;
    recording.time.push_back(time);
    recording.condition.push_back(0);
    for (std::size_t t = 0; t < kTaxels; ++t) {
      recording.counts.push_back(static_cast<std::uint16_t>(load + static_cast<double>((i + int(t)) % 3)));
    }
  }
  return recording;
}

void set(dataset::Recording& recording, std::size_t taxel, double from, double to, std::uint16_t code) {
  for (std::size_t i = 0; i < recording.scans(); ++i) {
    const double time = recording.time[i];
    if (time >= from && time < to)
      recording.counts[i * kTaxels + taxel] = static_cast<std::uint16_t>(code - i % 2);
  }
}

SocketCheck check(const dataset::Recording& recording) {
  return checkSocket(recording, {}, nullptr);
}

TEST(SocketCheck, AcceptsAGoodRecordingAndClaimsNoAccuracy) {
  const SocketCheck result = check(worn());
  EXPECT_TRUE(result.reasons.empty()) << result.reasons.front();
  ASSERT_TRUE(result.before && result.after);
  EXPECT_LE(result.before->to, 10.0);
  EXPECT_GE(result.after->from, 70.0);
  EXPECT_NEAR(result.median_change, 0, 1e-3);
}

TEST(SocketCheck, ComparesRestAfterWithRestBefore) {
  const SocketCheck result = check(worn(40 + 0.03 * 4095));
  EXPECT_NEAR(result.median_change, 0.03, 1e-3);
  EXPECT_EQ(result.changed, kTaxels);
  ASSERT_EQ(result.reasons.size(), 1u);
  EXPECT_NE(result.reasons.front().find("changed between rest before and rest after"), std::string::npos);
}

TEST(SocketCheck, ReportsAMissingRest) {
  dataset::Recording recording = worn();
  for (std::size_t t = 0; t < kTaxels; ++t) set(recording, t, 60, 80, 900);
  const SocketCheck result = check(recording);
  EXPECT_FALSE(result.after);
  EXPECT_TRUE(result.change.empty());
  EXPECT_NE(result.reasons.front().find("no rest was recorded after"), std::string::npos);
}

TEST(SocketCheck, UsesTheEventsOfPuttingOnAndOff) {
  dataset::Recording recording = worn();
  DonDoff events;
  events.don = 4.0;
  events.doff = 75.0;
  const SocketCheck result = checkSocket(recording, events, nullptr);
  EXPECT_LE(result.before->to, 4.0);
  EXPECT_GE(result.after->from, 75.0);
}

TEST(SocketCheck, FindsTheLongestStaticLoad) {
  dataset::Recording recording = worn();
  set(recording, 5, 20, 55, 1500);  // the others change with each step
  const SocketCheck result = check(recording);
  EXPECT_EQ(result.longest.taxel, 5u);
  EXPECT_NEAR(result.longest.seconds, 35, 1.01);
  EXPECT_NEAR(result.longest.from, 20, 1.01);
  for (std::size_t t = 6; t < kTaxels; ++t) set(recording, t, 20, 55, 1500);  // the sheet stays loaded
  for (double& time : recording.time) time *= 10;                             // 350 s
  EXPECT_EQ(check(recording).reasons.size(), 1u);
}

// A sheet that stays bent over a liner reads 30 % of its load after it was taken off.
dataset::Recording restingBent() {
  dataset::Recording recording = worn();
  for (std::size_t i = 0; i < recording.scans(); ++i) {
    if (recording.time[i] >= 10 && recording.time[i] < 70) continue;
    for (std::size_t t = 0; t < kTaxels; ++t) recording.counts[i * kTaxels + t] = 450;
  }
  return recording;
}

TEST(SocketCheck, FindsTheRestOfASheetThatIsStillBent) {
  const SocketCheck result = check(restingBent());
  ASSERT_TRUE(result.before && result.after);
  EXPECT_GE(result.after->from, 69.0);
}

TEST(SocketCheck, TakesNoRestAfterTakingOffForAStaticLoad) {
  DonDoff events;
  events.don = 10.0;
  events.doff = 70.0;
  const SocketCheck result = checkSocket(restingBent(), events, nullptr);
  EXPECT_LT(result.longest.seconds, 5);
  EXPECT_LT(check(restingBent()).longest.seconds, 5);  // nor without events
}

TEST(SocketCheck, FindsTheRestAlthoughTakingOffWasMarkedLate) {
  DonDoff events;
  events.doff = 79.5;
  const SocketCheck result = checkSocket(worn(), events, nullptr);
  ASSERT_TRUE(result.after);
  EXPECT_GE(result.after->from, 70.0);
}

TEST(SocketCheck, CountsReadingsAtFullScale) {
  dataset::Recording recording = worn();
  for (std::size_t i = 0; i < recording.scans(); ++i) {
    if (recording.time[i] < 20 || recording.time[i] >= 40) continue;
    for (std::size_t t = 0; t < 4; ++t) recording.counts[i * kTaxels + t] = 4095;
  }
  const SocketCheck result = check(recording);
  EXPECT_NEAR(result.saturated, 4.0 / 12 * 20 / 80, 1e-3);
  EXPECT_NE(result.reasons.front().find("full scale"), std::string::npos);
}

TEST(SocketCheck, CountsReadingsOutsideTheRangeOfTraining) {
  calibration::Calibration calibration;
  calibration.layout.size = {3, 4};
  calibration.tables = test_support::smallTables({3, 4}, {0.0, 10.0}, 4095);
  dataset::Recording recording = worn();
  recording.conditions.front().curvature = {matrix::Curvature{40, 0, 0}};
  const SocketCheck result = checkSocket(recording, {}, &calibration);
  EXPECT_EQ(result.bent_beyond, 1.0);
  EXPECT_FALSE(std::isnan(result.beyond));
  EXPECT_FALSE(std::isnan(result.median_pressure_change));
}

TEST(SocketCheck, RefusesACalibrationOfAnotherMatrix) {
  calibration::Calibration calibration;
  calibration.layout.size = {2, 2};
  calibration.tables = test_support::smallTables({2, 2}, {0.0}, 4095);
  EXPECT_THROW(checkSocket(worn(), {}, &calibration), settings::InputError);
  EXPECT_THROW(checkSocket(dataset::Recording{}, {}, nullptr), settings::InputError);
}

}  // namespace
}  // namespace fsr::check
