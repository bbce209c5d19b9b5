#include "protocol/device_clock.h"

#include <gtest/gtest.h>

namespace {

constexpr std::int64_t kMillisecond = 1'000'000;  // [ns]

fsr::protocol::PacketHeader at(std::uint32_t device_time, std::size_t size) {
  return {0, device_time, size};
}

TEST(PacketStamper, SubtractsTheTimeOnTheLineAndHalfTheScan) {
  fsr::protocol::PacketStamper stamper;
  stamper.startLine(115200);
  stamper.setArrival(1000 * kMillisecond);
  // 168 bytes of 10 bits at 115,200 1/s: 14.583333 ms; half of a scan of 5 ms: 2.5 ms.
  const fsr::protocol::PacketTime time = stamper.scan(at(7000, 168), 5000);
  EXPECT_EQ(time.stamp, 1000 * kMillisecond - 14'583'333 - 2'500'000);
  EXPECT_EQ(time.device_time, 7000U);
}

TEST(PacketStamper, SubtractsNoTimeOnTheLineWithoutBaud) {
  fsr::protocol::PacketStamper stamper;
  stamper.startLine(0);
  stamper.setArrival(1000 * kMillisecond);
  EXPECT_EQ(stamper.transducer(at(7000, 24)).stamp, 1000 * kMillisecond);
}

TEST(PacketStamper, StampsScansAndReadingsWithOneClock) {
  fsr::protocol::PacketStamper stamper;
  stamper.startLine(115200);
  stamper.setArrival(1000 * kMillisecond);
  const std::int64_t scan = stamper.scan(at(100'000, 168), 5000).stamp;
  // Sampled 1 ms after the middle of the scan but received much later: only the first packet shows the delay.
  stamper.setArrival(1040 * kMillisecond);
  EXPECT_EQ(stamper.transducer(at(101'000, 24)).stamp, scan + 1 * kMillisecond);
}

TEST(PacketStamper, StampsAnEdgeOnTheClockOfTheScansAndNoticesAResetInIt) {
  fsr::protocol::PacketStamper stamper;
  stamper.startLine(0);
  stamper.setArrival(50'000 * kMillisecond);
  stamper.scan(at(50'000'000, 168), 0);
  stamper.setArrival(50'018 * kMillisecond);  // sent behind the next scan
  EXPECT_EQ(stamper.trigger(at(50'003'000, 25)).stamp, 50'003 * kMillisecond);
  stamper.setArrival(52'000 * kMillisecond);
  EXPECT_EQ(stamper.trigger(at(1000, 25)).stamp, 52'000 * kMillisecond) << "the board started again";
}

TEST(PacketStamper, GivesPacketsOfOneReadDifferentStamps) {
  fsr::protocol::PacketStamper stamper;
  stamper.startLine(0);
  stamper.setArrival(1000 * kMillisecond);
  const std::int64_t first = stamper.scan(at(10'000, 168), 0).stamp;
  const std::int64_t second = stamper.scan(at(20'000, 168), 0).stamp;
  // The second packet shows that the first was 10 ms late. Its stamp may not decrease; it catches up at half
  // speed.
  EXPECT_EQ(second, first + 5 * kMillisecond);
  EXPECT_EQ(stamper.transducer(at(20'000, 24)).stamp, 1000 * kMillisecond);
}

TEST(PacketStamper, IsNotMisledByADurationThatCannotBe) {
  fsr::protocol::PacketStamper stamper;
  stamper.startLine(0);
  const auto scan = [&](std::uint32_t number, std::uint32_t duration) {
    stamper.setArrival((1000 + 10 * number) * kMillisecond);
    return stamper.scan({number, number * 10'000, 168}, duration).stamp;
  };
  EXPECT_EQ(scan(0, 4'294'000'000U),
            1000 * kMillisecond);  // the period is not known yet: no duration is used
  for (std::uint32_t number = 1; number < 100; ++number) scan(number, 8000);
  EXPECT_EQ(scan(100, 8000), 1996 * kMillisecond);
  EXPECT_EQ(scan(101, 4'294'000'000U), 2006 * kMillisecond);  // as the scans before it
  EXPECT_EQ(scan(102, 8000), 2016 * kMillisecond);
  EXPECT_EQ(stamper.impossibleDurations(), 2U);
  EXPECT_EQ(stamper.clock().jumps() + stamper.clock().smallJumps(), 0U);
}

// A stamper, and scans every 10 ms that arrive without delay after half their duration of 8 ms.
struct Scans {
  fsr::protocol::PacketStamper stamper;

  Scans() { stamper.startLine(0); }
  // Error of the stamp [ns].
  std::int64_t error(std::uint32_t number, std::uint32_t duration = 8000) {
    const std::int64_t middle = (1000 + 10 * std::int64_t{number}) * kMillisecond;
    stamper.setArrival(middle + 4 * kMillisecond);
    return stamper.scan({number, number * 10'000, 168}, duration).stamp - middle;
  }
};

TEST(PacketStamper, IsNotMisledByTheDurationOfAFirstScan) {
  Scans scans;
  scans.error(0, 200'000);  // less than a second, but the scan behind it comes after 10 ms
  for (std::uint32_t number = 1; number < 20; ++number) EXPECT_EQ(scans.error(number), 0) << number;
  EXPECT_EQ(scans.stamper.impossibleDurations(), 1U);
}

TEST(PacketStamper, IsNotMisledByADurationAfterAPause) {
  Scans scans;
  for (std::uint32_t number = 0; number < 20; ++number) scans.error(number);
  // The board paused for a second: its counter went on by one.
  const auto paused = [&](std::uint32_t number, std::uint32_t duration) {
    scans.stamper.setArrival((2004 + 10 * std::int64_t{number}) * kMillisecond);
    return scans.stamper.scan({number, 1'000'000 + number * 10'000, 168}, duration).stamp;
  };
  EXPECT_EQ(paused(20, 200'000), 2200 * kMillisecond);
  EXPECT_EQ(paused(21, 200'000), 2210 * kMillisecond);
  EXPECT_EQ(paused(22, 8000), 2220 * kMillisecond);
  EXPECT_EQ(scans.stamper.impossibleDurations(), 2U);
}

TEST(PacketStamper, KnowsTheDurationOfScansAfterTheBoardsCounterStartedAgain) {
  Scans scans;
  for (std::uint32_t number = 50; number < 70; ++number) scans.error(number);
  const auto restarted = [&](std::uint32_t number, std::uint32_t duration) {
    scans.stamper.setArrival((1704 + 10 * std::int64_t{number}) * kMillisecond);
    return scans.stamper.scan({number, (70 + number) * 10'000, 168}, duration).stamp;
  };
  EXPECT_EQ(restarted(0, 8000), 1700 * kMillisecond);
  EXPECT_EQ(restarted(1, 200'000), 1710 * kMillisecond);
  EXPECT_EQ(scans.stamper.impossibleDurations(), 1U);
}

// Without a counter each scan has the same number.
TEST(PacketStamper, IsNotMisledByADurationOfABoardThatDoesNotCount) {
  fsr::protocol::PacketStamper stamper;
  stamper.startLine(0);
  for (std::uint32_t number = 0; number < 20; ++number) {
    stamper.setArrival((1004 + 10 * std::int64_t{number}) * kMillisecond);
    const bool wrong = number == 10;
    EXPECT_EQ(stamper.scan({0, number * 10'000, 168}, wrong ? 200'000 : 8000).stamp,
              (1000 + 10 * std::int64_t{number}) * kMillisecond);
  }
  EXPECT_EQ(stamper.impossibleDurations(), 1U);
}

TEST(PacketStamper, StampsATemperatureWithoutUpdatingTheClock) {
  fsr::protocol::PacketStamper stamper;
  stamper.startLine(0);
  stamper.setArrival(1000 * kMillisecond);
  EXPECT_EQ(stamper.temperature(at(3'000'000, 24)).stamp, 1000 * kMillisecond)
      << "without a clock: its arrival";
  stamper.scan(at(10'000'000, 168), 0);
  stamper.setArrival(11'000 * kMillisecond);
  EXPECT_EQ(stamper.temperature(at(15'000'000, 24)).stamp, 6000 * kMillisecond);
  EXPECT_EQ(stamper.clock().jumps(), 0U);
}

}  // namespace
