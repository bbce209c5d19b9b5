#include "emulator/line_damage.h"

#include <gtest/gtest.h>

#include <cmath>

#include "fsr_pressure_map/settings/input_error.h"

namespace {

using fsr::emulator::heardByUart;
using fsr::emulator::LineDamage;
using fsr::emulator::LossyLine;
using Bytes = std::vector<std::uint8_t>;

TEST(HeardByUart, IsWhatWasSentAtTheRightSpeedAndWithinItsTolerance) {
  const Bytes sent = {0x00, 0xFF, 0xA5, 0x5A, 0x12};
  EXPECT_EQ(heardByUart(sent, 115200, 115200), sent);
  EXPECT_EQ(heardByUart(sent, 115200, 117500), sent);  // 2 %
  EXPECT_EQ(heardByUart(sent, 117500, 115200), sent);
}

// By hand: at twice the speed every bit is sampled twice. 0xFF is low for the start bit only, so start bit
// and bit 0 are low, the rest is high. 0x00 is low for nine bits, more than one frame, and has no second
// edge.
TEST(HeardByUart, SeesEachBitTwiceAtTwiceTheSpeed) {
  EXPECT_EQ(heardByUart({0xFF}, 57600, 115200), Bytes{0xFE});
  EXPECT_EQ(heardByUart({0x00}, 57600, 115200), Bytes{0x00});
  // 0x0F: low 1, high 4, low 4, high: frame 0 0 1111111 1 -> 0xFE; then the low from bit 5 to 8: 0x00 of
  // eight low receiver bits, one start and seven of data, and a high one.
  EXPECT_EQ(heardByUart({0x0F}, 57600, 115200), (Bytes{0xFE, 0x80}));
}

// By hand: at half the speed the samples fall on the boundaries 1, 3, 5 ... of the sender's bits. The start
// bit of 0xFF has ended by then and is ignored as a spike. 0x00 is low until 9: bits 0 to 2 (at 3, 5, 7) are
// low, then high.
TEST(HeardByUart, SkipsEveryOtherBitAtHalfTheSpeed) {
  EXPECT_EQ(heardByUart({0xFF}, 115200, 57600), Bytes{});
  EXPECT_EQ(heardByUart({0x00}, 115200, 57600), Bytes{0xF8});
}

// A receiver that is sixteen times as fast completes its frame within the start bit, so every sample is low.
TEST(HeardByUart, OfAMuchFasterReceiverAreZeros) {
  EXPECT_EQ(heardByUart({0xFF}, 57600, 921600), Bytes{0x00});
  EXPECT_EQ(heardByUart({0x00, 0xFF}, 57600, 921600), (Bytes{0x00, 0x00}));
}

TEST(LossyLine, LosesAndDoublesWholePacketsAndAddsNoise) {
  LossyLine line(3);
  LineDamage damage;
  damage.lost_packets = 0.2;
  damage.doubled_packets = 0.1;
  std::size_t lost = 0, doubled = 0;
  for (int i = 0; i < 10000; ++i) {
    Bytes packet = {1, 2, 3};
    line.pass(damage, packet);
    lost += packet.empty();
    doubled += packet == Bytes{1, 2, 3, 1, 2, 3};
  }
  EXPECT_NEAR(static_cast<double>(lost), 2000, 160);    // four standard deviations
  EXPECT_NEAR(static_cast<double>(doubled), 800, 110);  // of those that were not lost
  EXPECT_EQ(line.counts().lost_packets, lost);
  EXPECT_EQ(line.counts().doubled_packets, doubled);
  damage = {};
  damage.noise = 2;
  Bytes packet = {1, 2, 3};
  line.pass(damage, packet);
  EXPECT_EQ(packet.size(), 9u);
  EXPECT_EQ(line.counts().noise_bytes, 6u);
}

TEST(LossyLine, LosesAndFlipsAtTheGivenRates) {
  LossyLine line(3);
  LineDamage damage;
  damage.lost_bytes = 0.01;
  damage.flipped_bits = 0.002;
  constexpr double kBytes = 200000;
  Bytes bytes(static_cast<std::size_t>(kBytes), 0);
  line.pass(damage, bytes);
  const double lost = kBytes - static_cast<double>(bytes.size());
  double flipped = 0;
  for (const std::uint8_t byte : bytes) flipped += __builtin_popcount(byte);
  EXPECT_NEAR(lost, 0.01 * kBytes, 5 * std::sqrt(0.01 * kBytes));
  EXPECT_NEAR(flipped, 0.002 * 8 * kBytes, 5 * std::sqrt(0.002 * 8 * kBytes));
  EXPECT_EQ(line.counts().lost_bytes, lost);
  EXPECT_EQ(line.counts().flipped_bits, flipped);
}

TEST(LineDamage, RefusesValuesThatAreNotProbabilities) {
  LineDamage damage;
  damage.lost_bytes = 1.5;
  EXPECT_THROW(validate(damage), fsr::settings::InputError);
  damage = {};
  damage.flipped_bits = std::nan("");
  EXPECT_THROW(validate(damage), fsr::settings::InputError);
}

}  // namespace
