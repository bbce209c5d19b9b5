#include "ros/live/driver_health.h"

#include <gtest/gtest.h>

#include <string>

namespace {

using fsr::protocol::LinkPhase;
using fsr_ros::DriverHealth;
using fsr_ros::DriverSettings;
using Level = diagnostic_msgs::DiagnosticStatus;
using Status = diagnostic_updater::DiagnosticStatusWrapper;

DriverHealth reading() {
  DriverHealth health;
  health.link.phase = LinkPhase::kReading;
  return health;
}

// The state a second later, with `scans` further scans at the board's 100 Hz.
DriverHealth later(DriverHealth health, std::uint64_t scans) {
  health.scans += scans;
  health.scan_time += 10'000 * scans;
  health.link.counts.bytes += 168 * scans;
  health.link.counts.sequences[0].packets += scans;
  return health;
}

Status link(const DriverHealth& before, const DriverHealth& now, const DriverSettings& settings = {}) {
  Status status;
  fsr_ros::judgeLink(before, now, settings, status);
  return status;
}

Status scans(const DriverHealth& before, const DriverHealth& now, const DriverSettings& settings = {}) {
  Status status;
  fsr_ros::judgeScans(before, now, settings, status);
  return status;
}

bool contains(const Status& status, const std::string& part) {
  return status.message.find(part) != std::string::npos;
}

TEST(DriverHealth, IsOkWhileScansCome) {
  const DriverHealth before = later(reading(), 100);
  const DriverHealth now = later(before, 100);
  EXPECT_EQ(link(before, now).level, Level::OK);
  EXPECT_EQ(link(before, now).message, "reading /dev/ttyACM0");
  EXPECT_EQ(scans(before, now).level, Level::OK);
  EXPECT_EQ(scans(before, now).message, "100 scans a second");
}

TEST(DriverHealth, SaysWhyItWaits) {
  DriverHealth now;
  now.link.phase = LinkPhase::kWaiting;
  now.link.reason = "there is no serial port /dev/ttyACM0: plug the board in";
  EXPECT_EQ(link(now, now).level, Level::ERROR);
  EXPECT_EQ(link(now, now).message, "waiting for the board: " + now.link.reason);
  EXPECT_TRUE(contains(scans(now, now), now.link.reason));
}

TEST(DriverHealth, ComplainsAboutSilenceBeyondTheTimeout) {
  DriverHealth now = reading();
  now.link.silence = 0.9;
  EXPECT_EQ(link(now, now).level, Level::OK);
  now.link.silence = 1.5;
  EXPECT_EQ(link(now, now).level, Level::ERROR);
  EXPECT_TRUE(contains(link(now, now), "/dev/ttyACM0 has sent nothing for 1.5 s")) << link(now, now).message;
}

TEST(DriverHealth, SaysToTheLogWhyAnOpenPortGivesNoScans) {
  const DriverHealth before = reading();
  const auto complaint = [&](const DriverHealth& now) { return fsr_ros::complaintOf(before, now, {}); };
  EXPECT_EQ(complaint(before), "") << "the first scan may be on its way";
  EXPECT_EQ(complaint(later(before, 100)), "");
  DriverHealth silent = before, noise = before, impossible = before;
  silent.link.silence = 2;
  EXPECT_NE(complaint(silent).find("has sent nothing for 2 s"), std::string::npos) << complaint(silent);
  noise.link.counts.bytes = noise.link.counts.skipped_bytes = 1000;
  EXPECT_NE(complaint(noise).find("is serial_baud 115200 the baud rate"), std::string::npos)
      << complaint(noise);
  impossible.link.counts.bad_content = 20;
  EXPECT_NE(complaint(impossible).find("counts above the full scale"), std::string::npos)
      << complaint(impossible);
}

TEST(DriverHealth, BlamesTheDriverAndNotTheLinkForAFailingHandler) {
  const DriverHealth before = reading();
  DriverHealth now = reading();
  now.link.handler_faults = 1;
  now.link.handler_complaint = "handling a scan failed in this program, not on the link: out of memory";
  EXPECT_EQ(link(before, now).level, Level::ERROR);
  EXPECT_TRUE(contains(link(before, now), now.link.handler_complaint)) << link(before, now).message;
  EXPECT_FALSE(contains(link(before, now), "waiting")) << link(before, now).message;
}

TEST(DriverHealth, SuspectsAWrongBaudRateWhenOnlyNoiseComes) {
  const DriverHealth before = reading();
  DriverHealth now = reading();
  now.link.counts.bytes = 500;
  now.link.counts.skipped_bytes = 490;
  EXPECT_EQ(link(before, now).level, Level::ERROR);
  EXPECT_TRUE(contains(link(before, now), "is serial_baud 115200 the baud rate of the board"))
      << link(before, now).message;
}

TEST(DriverHealth, WarnsBeyondTheToleranceOfTheRateOnly) {
  DriverSettings settings;
  settings.expected_frequency = 100;
  const DriverHealth before = later(reading(), 1);
  DriverHealth now = later(before, 91);
  now.scan_time = before.scan_time + 1'000'000;
  EXPECT_EQ(scans(before, now, settings).level, Level::OK);
  now.scans = before.scans + 89;
  EXPECT_EQ(scans(before, now, settings).level, Level::WARN);
  EXPECT_EQ(scans(before, now, settings).message, "89 scans a second, but 100 are expected");
}

TEST(DriverHealth, ExpectsTheRateThatTheBoardReports) {
  DriverHealth before = later(reading(), 1);
  before.board.scan_period = 0.005;
  EXPECT_EQ(scans(before, later(before, 100)).message, "100 scans a second, but 200 are expected");
}

TEST(DriverHealth, JudgesNoRateFromItsFirstScans) {
  DriverSettings settings;
  settings.expected_frequency = 100;
  EXPECT_EQ(scans(reading(), later(reading(), 5), settings).level, Level::OK);
}

TEST(DriverHealth, RefusesABoardOfAnotherSize) {
  DriverSettings settings;
  settings.expected = {7, 10};
  DriverHealth now = reading();
  now.board.size = {16, 10};
  now.refused_scans = 3;
  EXPECT_EQ(scans(reading(), now, settings).level, Level::ERROR);
  EXPECT_EQ(
      scans(reading(), now, settings).message,
      "the board sends 16 x 10 taxels, but the parameters rows and columns are 7 x 10: no scan is published");
}

TEST(DriverHealth, IsOkAfterAReplayAndReportsACutCapture) {
  DriverSettings settings;
  settings.replay_file = "/data/run.fsrcap";
  DriverHealth now;
  now.link.phase = LinkPhase::kEnded;
  now.link.reason = "capture /data/run.fsrcap is cut short at byte 90: replayed up to there";
  EXPECT_EQ(link(now, now, settings).level, Level::OK);
  EXPECT_EQ(link(now, now, settings).message, "replay of /data/run.fsrcap has ended: " + now.link.reason);
  EXPECT_EQ(scans(now, now, settings).level, Level::OK);
}

TEST(DriverHealth, ComplainsAboutACaptureThatStopped) {
  DriverHealth now = reading();
  now.link.capture_complaint = "capture /data/run.fsrcap cannot be continued (No space left on device)";
  EXPECT_EQ(link(now, now).level, Level::ERROR);
  EXPECT_TRUE(contains(link(now, now), "No space left on device"));
}

TEST(DriverHealth, ListsLossesAndDamageByCause) {
  DriverHealth now = reading();
  now.link.counts.bad_packet_check = 7;
  now.link.counts.sequences[0].lost = 12;
  const Status status = scans(reading(), now);
  int found = 0;
  for (const auto& value : status.values) {
    if (value.key == "scans lost") found += value.value == "12" ? 1 : 0;
    if (value.key == "dropped: packet check") found += value.value == "7" ? 1 : 0;
  }
  EXPECT_EQ(found, 2);
}

}  // namespace
