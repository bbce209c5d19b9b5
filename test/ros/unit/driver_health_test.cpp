#include "ros/driver/driver_health.h"
#include "support/holds.h"

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
  EXPECT_TRUE(test_support::holds(scans(before, now, settings).message, {"89", "100", "89 scans a second"}));
}

TEST(DriverHealth, ExpectsTheRateThatTheBoardReports) {
  DriverHealth before = later(reading(), 1);
  before.board.scan_period = 0.005;
  EXPECT_TRUE(
      test_support::holds(scans(before, later(before, 100)).message, {"100", "200", "100 scans a second"}));
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
  EXPECT_TRUE(test_support::holds(scans(reading(), now, settings).message, {"16 x 10 taxels", "7 x 10"}));
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

DriverSettings textSettings(std::uint32_t tick = 1000) {
  DriverSettings settings;
  settings.protocol = "text";
  settings.decoder = {{7, 10}, 1023, tick, false};
  return settings;
}

std::string valueOf(const Status& status, const std::string& key) {
  for (const auto& value : status.values) {
    if (value.key == key) return value.value;
  }
  return "";
}

TEST(TextHealth, ListsDamagedLinesByCauseInPlaceOfPackets) {
  DriverHealth now = reading();
  now.link.counts.lines = {1, 2, 3, 4, 5, 6, 7, 71, 2000};
  const Status status = scans(reading(), now, textSettings());
  EXPECT_EQ(valueOf(status, "dropped: line cut by start or end"), "1");
  EXPECT_EQ(valueOf(status, "lines without numbers"), "2");
  EXPECT_EQ(valueOf(status, "dropped: line too long"), "3");
  EXPECT_EQ(valueOf(status, "dropped: line not in ASCII"), "4");
  EXPECT_EQ(valueOf(status, "dropped: line not of whole numbers"), "5");
  EXPECT_EQ(valueOf(status, "dropped: wrong number of counts"), "6");
  EXPECT_EQ(valueOf(status, "dropped: count above full scale"), "7");
  EXPECT_EQ(valueOf(status, "dropped: packet check"), "");
  EXPECT_EQ(valueOf(scans(reading(), now), "dropped: line too long"), "");
}

TEST(TextHealth, SaysThatRowsAndColumnsAreNotThoseOfTheLines) {
  DriverHealth now = reading();
  now.link.counts.bad_content = now.link.counts.lines.wrong_number = 100;
  now.link.counts.lines.last_number = 160;
  const std::string sentence =
      "no scan is published: /dev/ttyACM0 sends lines with 160 numbers behind the time, but rows x columns "
      "is "
      "7 x 10 = 70 counts: set rows and columns to those of the matrix";
  EXPECT_EQ(scans(reading(), now, textSettings()).level, Level::ERROR);
  EXPECT_EQ(scans(reading(), now, textSettings()).message, sentence);
  EXPECT_EQ(fsr_ros::complaintOf(reading(), now, textSettings()), sentence);
}

// An unloaded sheet may stay below the full scale that is set, so that its scans come.
TEST(TextHealth, SaysThatTheFullScaleIsTooSmallWhetherScansComeOrNot) {
  DriverHealth now = reading();
  now.link.counts.bad_content = now.link.counts.lines.above_full_scale = 50;
  now.link.counts.lines.highest_count = 4095;
  const std::string sentence =
      "/dev/ttyACM0 sends counts up to 4095, but text_full_scale is 1023: set it to the largest count that "
      "the "
      "board's converter can give";
  EXPECT_EQ(scans(reading(), now, textSettings()).level, Level::ERROR);
  EXPECT_EQ(scans(reading(), now, textSettings()).message, "no scan is published: " + sentence);
  now = later(now, 50);
  EXPECT_EQ(scans(reading(), now, textSettings()).level, Level::WARN);
  EXPECT_TRUE(contains(scans(reading(), now, textSettings()), "some scans are not published: " + sentence))
      << scans(reading(), now, textSettings()).message;
}

// 100 scans at 100 Hz: the host's clock advances by 1 s, that of the board by what its unit makes of it.
TEST(TextHealth, SaysThatTheTimesHaveTheOtherUnit) {
  const auto judged = [](std::uint64_t board_us, std::uint32_t tick) {
    DriverHealth before = later(reading(), 1);
    before.scan_time = 5'000;
    DriverHealth now = later(before, 100);
    now.scan_time = before.scan_time + board_us;
    now.scan_arrival = 1'000'000'000;
    return scans(before, now, textSettings(tick));
  };
  EXPECT_EQ(judged(1'000'000, 1000).level, Level::OK);
  EXPECT_EQ(judged(1'000'000, 1).level, Level::OK);
  EXPECT_EQ(judged(1'000'000'000, 1000).level, Level::ERROR);
  EXPECT_TRUE(test_support::holds(judged(1'000'000'000, 1000).message, {"/dev/ttyACM0", "text_time"}));
  EXPECT_EQ(judged(1'000, 1).level, Level::ERROR);
  EXPECT_TRUE(contains(judged(1'000, 1), "set text_time to ms")) << judged(1'000, 1).message;
}

// The first line of an open port is cut, and its bytes are skipped as those of noise are.
TEST(TextHealth, SuspectsNoBaudRateWhereLinesOfAnotherMatrixCome) {
  DriverHealth wrong = reading(), long_lines = reading();
  wrong.link.counts.bytes = long_lines.link.counts.bytes = 1000;
  wrong.link.counts.skipped_bytes = long_lines.link.counts.skipped_bytes = 20;
  wrong.link.counts.lines.wrong_number = wrong.link.counts.bad_content =
      long_lines.link.counts.lines.too_long = 5;
  wrong.link.counts.lines.last_number = 12;
  const auto log = [](const DriverHealth& now) {
    return fsr_ros::complaintOf(reading(), now, textSettings());
  };
  EXPECT_EQ(log(wrong).find("no scan is published: /dev/ttyACM0 sends lines with 12 numbers"), 0U)
      << log(wrong);
  EXPECT_EQ(log(long_lines).find("no scan is published: /dev/ttyACM0 sends lines with many more numbers"), 0U)
      << log(long_lines);
}

TEST(TextHealth, SuspectsAWrongBaudRateWhereNoLineHasNumbers) {
  DriverHealth now = reading();
  now.link.counts.bytes = now.link.counts.skipped_bytes = 1000;
  EXPECT_TRUE(test_support::holds(link(reading(), now, textSettings()).message,
                                  {"/dev/ttyACM0", "serial_baud 115200"}));
}

}  // namespace
