#include "protocol/device_clock.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <random>
#include <vector>

namespace {

constexpr double kMs = 1e-3;  // [s]
constexpr double kUs = 1e-6;  // [s]

// A board and its link with known host times of device times [s] and known delays of packets.
struct Link {
  double offset = 1.7e9;  // host time of device time 0 [s]
  double drift = 50e-6;   // the host's clock runs faster by this
  double first = 12.0;    // device time of the first packet [s]
  double period = 10e-3;  // of the packets [s]
  std::function<double(double host)> delay = [](double) { return 0.0; };  // at host time [s] -> [s]

  double truth(double device) const { return device * (1 + drift); }  // without the offset [s]
};

// Largest and smallest error of host times from `settled` to `duration` [s after the first packet].
struct Errors {
  double lowest = 0;
  double highest = 0;
};

Errors run(const Link& link, double duration, double settled, fsr::protocol::DeviceClock& clock) {
  Errors errors = {1e9, -1e9};
  const std::int64_t offset_ns = std::llround(link.offset * 1e9);
  for (double t = 0; t < duration; t += link.period) {
    const double device = link.first + t;
    const double sent = link.truth(device);
    const double arrival = sent + link.delay(sent);
    const auto stamp = static_cast<std::uint32_t>(static_cast<std::uint64_t>(std::llround(device * 1e6)));
    const std::uint64_t wide = clock.observe(stamp, offset_ns + std::llround(arrival * 1e9), 0);
    const double error = static_cast<double>(clock.hostTime(wide) - offset_ns) * 1e-9 - sent;
    if (t < settled) continue;
    errors.lowest = std::min(errors.lowest, error);
    errors.highest = std::max(errors.highest, error);
  }
  return errors;
}

std::function<double(double)> exponential(double mean, unsigned seed) {
  auto random = std::make_shared<std::mt19937>(seed);
  return [random, mean](double) { return std::exponential_distribution<double>(1 / mean)(*random); };
}

TEST(DeviceClock, FollowsOffsetAndDriftThroughRandomDelays) {
  Link link;
  link.delay = exponential(2 * kMs, 1);
  fsr::protocol::DeviceClock clock;
  const Errors errors = run(link, 600, 10, clock);
  // A slot of 2 s holds 200 arrivals; the smallest of 200 exponential delays of mean 2 ms is 10 us in the
  // mean, and the envelope rests on the lowest of 64 slots. Ten times that mean covers the short slots of the
  // start.
  EXPECT_GT(errors.lowest, -100 * kUs);
  EXPECT_LT(errors.highest, 100 * kUs);
  EXPECT_NEAR(clock.drift(), 50e-6, 1e-6);
  EXPECT_EQ(clock.jumps(), 0U);
}

TEST(DeviceClock, RemovesTheJitterOfBatches) {
  Link link;
  // A USB adapter that delivers its bytes every 16 ms of its own clock.
  link.delay = [](double host) { return 16 * kMs - std::fmod(host, 16 * kMs); };
  fsr::protocol::DeviceClock clock;
  const Errors errors = run(link, 600, 10, clock);
  // Packets every 10 ms and batches every 16 ms have 8 phases 2 ms apart, which drift with 50 ppm. So the
  // smallest delay is a saw-tooth of 2 ms in 40 s, and the line lies within its height.
  EXPECT_GT(errors.lowest, -2 * kMs);
  EXPECT_LT(errors.highest, 2 * kMs);
  EXPECT_NEAR(clock.drift(), 50e-6, 10e-6);
}

TEST(DeviceClock, KeepsTheSpacingOfTheBoardUnderJitter) {
  Link link;
  auto batches = [](double host) { return 16 * kMs - std::fmod(host, 16 * kMs); };
  auto noise = exponential(1 * kMs, 2);
  link.delay = [=](double host) { return batches(host) + noise(host); };
  fsr::protocol::DeviceClock clock;
  run(link, 60, 60, clock);
  std::int64_t last = 0;
  for (double t = 60; t < 120; t += link.period) {
    const double sent = link.truth(link.first + t);
    const std::int64_t arrival = std::llround((link.offset + sent + link.delay(sent)) * 1e9);
    const std::int64_t host = clock.hostTime(
        clock.observe(static_cast<std::uint32_t>(std::llround((link.first + t) * 1e6)), arrival, 0));
    // The estimate may change at any packet, but by far less than the 16 ms jumps of the arrivals.
    const double spacing = last == 0 ? link.period : static_cast<double>(host - last) * 1e-9;
    EXPECT_NEAR(spacing, link.period, 0.3 * kMs) << t;
    last = host;
  }
}

TEST(DeviceClock, FollowsACeramicResonatorFromTheFirstSecond) {
  for (const double drift : {-5e-3, 5e-3}) {
    Link link;
    link.drift = drift;
    link.delay = exponential(1 * kMs, 3);
    fsr::protocol::DeviceClock clock;
    const Errors errors = run(link, 200, 1, clock);
    // Without a slope, 0.5 % over the window of 128 s would be 640 ms.
    EXPECT_GT(errors.lowest, -1 * kMs) << drift;
    EXPECT_LT(errors.highest, 1 * kMs) << drift;
  }
}

TEST(DeviceClock, FollowsADriftThatWandersWithTemperature) {
  Link link;
  constexpr double kTurn = 2 * M_PI / 1200;  // 20 minutes [1/s]
  // Rate 20 ppm sin: host - device changes by 20e-6 / kTurn (1 - cos), here treated as part of the delay.
  auto wander = [](double host) { return 20e-6 / kTurn * (1 - std::cos(kTurn * host)); };
  auto noise = exponential(1 * kMs, 4);
  link.delay = [=](double host) { return wander(host) + noise(host); };
  fsr::protocol::DeviceClock clock;
  Errors errors = {1e9, -1e9};
  for (double t = 0; t < 1200; t += link.period) {
    const double sent = link.truth(link.first + t);
    const std::int64_t arrival = std::llround((sent + link.delay(sent)) * 1e9);
    const std::uint64_t wide =
        clock.observe(static_cast<std::uint32_t>(std::llround((link.first + t) * 1e6)), arrival, 0);
    const double error = static_cast<double>(clock.hostTime(wide)) * 1e-9 - sent - wander(sent);
    if (t > 10) errors = {std::min(errors.lowest, error), std::max(errors.highest, error)};
  }
  // For a rate that changes by 0.1 ppm/s, the error of a line over a window of 128 s is about
  // 0.5 * 1e-7 * 128^2 = 0.8 ms.
  EXPECT_GT(errors.lowest, -1 * kMs);
  EXPECT_LT(errors.highest, 1 * kMs);
}

TEST(DeviceClock, SubtractsTheKnownDelay) {
  fsr::protocol::DeviceClock clock;
  const std::uint64_t wide = clock.observe(5000, 1'000'000'000, 14'583'333);
  EXPECT_EQ(wide, 5000U);
  EXPECT_EQ(clock.hostTime(wide), 985'416'667);
}

TEST(DeviceClock, ContinuesWhereThirtyTwoBitsWrap) {
  Link link;
  link.first = 4294.9;  // wraps at 4294.967296 s
  link.period = 1;
  fsr::protocol::DeviceClock clock;
  std::uint64_t last = 0;
  for (int i = 0; i < 9000; ++i) {  // the counter wraps twice
    const double device = link.first + i;
    const auto whole = static_cast<std::uint64_t>(std::llround(device * 1e6));
    const std::uint64_t wide = clock.observe(static_cast<std::uint32_t>(whole),
                                             std::llround((link.offset + link.truth(device)) * 1e9), 0);
    ASSERT_EQ(wide, whole);
    ASSERT_GT(wide, last);
    last = wide;
  }
  EXPECT_EQ(clock.jumps(), 0U);
}

TEST(DeviceClock, AcceptsPacketsOfASlightlyEarlierDeviceTime) {
  fsr::protocol::DeviceClock clock;
  clock.observe(1'000'000, 2'000'000'000, 0);
  const std::uint64_t older = clock.observe(960'000, 2'000'100'000, 0);
  EXPECT_EQ(older, 960'000U);
  EXPECT_EQ(clock.hostTime(older), 1'960'000'000);
  EXPECT_EQ(clock.jumps(), 0U);
}

// Feeds `count` packets 10 ms apart without delay; returns the host time of the last one [ns].
std::int64_t feed(fsr::protocol::DeviceClock& clock, int count, std::uint32_t device_us,
                  std::int64_t host_ns) {
  std::int64_t last = 0;
  for (int i = 0; i < count; ++i) {
    last = clock.hostTime(clock.observe(device_us + 10'000U * i, host_ns + std::int64_t{10'000'000} * i, 0));
  }
  return last;
}

TEST(DeviceClock, RestartsWhenTheBoardWasReset) {
  fsr::protocol::DeviceClock clock;
  feed(clock, 1000, 3'000'000'000U, 0);
  EXPECT_EQ(feed(clock, 100, 500, 30'000'000'000), 30'990'000'000);
  EXPECT_EQ(clock.jumps(), 1U);
}

TEST(DeviceClock, RestartsWhenTheBoardsClockJumpsAhead) {
  fsr::protocol::DeviceClock clock;
  feed(clock, 1000, 0, 0);
  EXPECT_EQ(feed(clock, 100, 500'000'000, 10'000'000'000), 10'990'000'000);
  EXPECT_EQ(clock.jumps(), 1U);
}

TEST(DeviceClock, RestartsWhenTheHostsClockIsSetBackOrAhead) {
  for (const std::int64_t step : {-3600'000'000'000, 3600'000'000'000}) {
    fsr::protocol::DeviceClock clock;
    feed(clock, 1000, 0, 0);
    EXPECT_EQ(feed(clock, 1000, 10'000'000, 10'000'000'000 + step), 19'990'000'000 + step);
    EXPECT_EQ(clock.jumps(), 1U);
  }
}

TEST(DeviceClock, NoticesASmallJumpWithinSecondsAndCountsWhatItMadeWrong) {
  for (const int step_us : {-300'000, -100'000, 100'000, 300'000}) {  // of the board's clock
    fsr::protocol::DeviceClock clock;
    feed(clock, 2000, 0, 0);
    const auto device = static_cast<std::uint32_t>(20'000'000 + step_us);
    const std::int64_t last = feed(clock, 1000, device, 20'000'000'000);
    EXPECT_EQ(last, 29'990'000'000) << step_us;
    EXPECT_EQ(clock.smallJumps(), 1U) << step_us;
    EXPECT_EQ(clock.jumps(), 0U) << step_us;
    EXPECT_NEAR(clock.lastJump().seconds, -1e-6 * step_us, 1e-3);
    // A clock that jumped ahead is noticed with the first packet, one that jumped back after 5 s.
    EXPECT_EQ(clock.doubtfulPackets(), step_us > 0 ? 0U : 501U) << step_us;
  }
}

TEST(DeviceClock, NoticesAJumpOfATenthOfASecondThroughTheJitterOfBatches) {
  for (const double step : {-0.1, 0.1}) {  // of the board's clock [s]
    Link link;
    link.delay = [](double host) { return 16 * kMs - std::fmod(host, 16 * kMs); };
    fsr::protocol::DeviceClock clock;
    run(link, 20, 20, clock);
    link.first += 20 + step;
    link.offset -= step;
    run(link, 10, 10, clock);
    EXPECT_EQ(clock.smallJumps(), 1U) << step;
    EXPECT_EQ(clock.jumps(), 0U) << step;
  }
}

TEST(DeviceClock, RestartsAtOnceWhenABoardWasResetSoonAfterItsStart) {
  fsr::protocol::DeviceClock clock;
  feed(clock, 300, 0, 0);
  EXPECT_EQ(feed(clock, 1, 500, 5'000'000'000), 5'000'000'000);
  EXPECT_EQ(clock.jumps(), 1U);
}

TEST(DeviceClock, IsNotChangedByAStallThatEnds) {
  fsr::protocol::DeviceClock clock;
  feed(clock, 100, 0, 0);
  // 4 s of packets arrive together when the computer wakes up. Then the link is as before.
  for (std::int64_t us = 1'000'000; us < 5'000'000; us += 10'000) {
    const std::uint64_t device = clock.observe(static_cast<std::uint32_t>(us), 5'000'000'000, 0);
    // A packet counts as late from 1 s on. Less late ones may tilt the line by the accepted drift of 2 %,
    // which is 80 ms in 4 s.
    ASSERT_NEAR(static_cast<double>(clock.hostTime(device) - us * 1000) * 1e-9, 0,
                us < 4'000'000 ? 1e-9 : 80 * kMs);
  }
  EXPECT_EQ(feed(clock, 1000, 5'000'000, 5'000'000'000), 14'990'000'000);
  EXPECT_EQ(clock.jumps(), 0U);
}

TEST(DeviceClock, ForgetsAnEarlierConnectionWithoutCountingAJump) {
  fsr::protocol::DeviceClock clock;
  feed(clock, 10, 3'000'000'000U, 0);
  clock.forget();
  EXPECT_EQ(feed(clock, 1, 7, 9'000'000'000), 9'000'000'000);
  EXPECT_EQ(clock.jumps(), 0U);
}

// Rig time at 20 times real time: a delay of 1 ms by the scheduler, of bytes or ticks, is 20 ms here.
TEST(DeviceClock, KeepsAnEvenSpacingUnderATickingClock) {
  Link link;
  link.drift = 0;
  link.period = 0.1;
  constexpr double kTick = 0.2;  // [s]
  auto bytes = exponential(20 * kMs, 5);
  auto ticks = exponential(20 * kMs, 6);
  link.delay = [=](double host) {
    const double arrival = host + bytes(host) - ticks(host);
    return std::floor(arrival / kTick) * kTick - host;
  };
  fsr::protocol::DeviceClockOptions options;
  options.host_ticks = true;
  fsr::protocol::DeviceClock clock(options);
  const Errors errors = run(link, 300, 20, clock);
  EXPECT_EQ(clock.jumps(), 0U);
  // Arrivals scatter by a tick (evenly spread: deviation 0.3 ticks) and by 28 ms; the mean of 200 after 20 s
  // scatters by 1/14 of that, 5 ms, and is compared over 280 s: 4 deviations on either side.
  EXPECT_NEAR(errors.lowest, -kTick / 2, 20 * kMs);
  EXPECT_NEAR(errors.highest, -kTick / 2, 20 * kMs);
}

TEST(DeviceClock, IsNotChangedByOccasionalTicksThatAreMuchTooLate) {
  Link link;
  link.drift = 0;
  link.period = 0.1;
  int packet = 0;
  link.delay = [&packet](double) { return ++packet % 20 == 0 ? -0.4 : 0.0; };
  fsr::protocol::DeviceClockOptions options;
  options.host_ticks = true;
  fsr::protocol::DeviceClock clock(options);
  const Errors errors = run(link, 300, 20, clock);
  EXPECT_NEAR(errors.lowest, 0, 1e-6);
  EXPECT_NEAR(errors.highest, 0, 1e-6);
}

TEST(StampSequence, CatchesUpAtHalfSpeedWhereTheEstimateSteppedBack) {
  fsr::protocol::StampSequence stamps;
  stamps.next(100'000'000, 0);
  // The estimate improves by 12 ms: 10 ms later the packet maps to 98 ms.
  EXPECT_EQ(stamps.next(98'000'000, 10'000), 105'000'000);
  EXPECT_EQ(stamps.next(108'000'000, 20'000), 110'000'000);
  EXPECT_EQ(stamps.next(118'000'000, 30'000), 118'000'000);
}

TEST(StampSequence, IncreasesEvenWhereDeviceTimeDoesNot) {
  fsr::protocol::StampSequence stamps;
  stamps.next(100'000'000, 5000);
  EXPECT_EQ(stamps.next(100'000'000, 5000), 100'001'000);
  EXPECT_EQ(stamps.next(90'000'000, 0), 100'002'000);
}

TEST(StampSequence, FollowsTheHostsTimeBackwards) {
  fsr::protocol::StampSequence stamps;
  stamps.next(100'000'000'000, 5000);
  EXPECT_EQ(stamps.next(2'000'000'000, 15'000), 2'000'000'000);
}

}  // namespace
