// Faults between a board and its pressure map, tested with an emulated board behind a pseudo-terminal that is
// read as the driver reads it. Every received scan is compared with what the board sent, every pressure with
// the table. docs/reliability.md lists the cost of each fault.
#include <gtest/gtest.h>

#include <filesystem>

#include "faults/fault_rig.h"
#include "support/file_size_limit.h"

namespace {

using fsr::emulator::LineDamage;
using fsr::protocol::LinkPhase;
using test_support::FaultBoard;
using test_support::FaultListener;
using test_support::kFaultPatience;

class LinkFaults : public testing::Test {
 protected:
  void SetUp() override { start("A"); }
  // No test may produce a wrong result, whatever the fault.
  void TearDown() override {
    EXPECT_EQ(listener_.wrong().scans, 0u);
    EXPECT_EQ(listener_.wrong().pressures, 0u);
    EXPECT_EQ(listener_.wrong().stamps, 0u);
    EXPECT_EQ(listener_.wrong().boards, 0u);
  }

  void start(const std::string& serial, std::uint32_t baud = 0, std::uint32_t clock_offset = 0) {
    board_ = std::make_unique<FaultBoard>(port_, sent_, serial, baud, clock_offset);
    if (reader_) return;
    const auto open = [this, baud] {
      return std::make_unique<fsr::protocol::SerialPort>(port_, baud, [this] { return now(); });
    };
    reader_ = std::make_unique<fsr::protocol::BoardReader>(
        open, listener_, fsr::protocol::BoardReader::Options{std::chrono::milliseconds(5), capture_});
  }
  void restart(const std::string& serial, std::uint32_t baud, std::uint32_t clock_offset = 0) {
    reader_.reset();
    start(serial, baud, clock_offset);
  }
  std::int64_t now() const {
    const auto time = std::chrono::steady_clock::now().time_since_epoch();
    return 1'000'000'000'000'000'000 + std::chrono::nanoseconds(time).count();
  }
  fsr::protocol::DecoderCounts counts() const { return reader_->report().counts; }
  fsr::protocol::SequenceCounts scanCounts() const { return counts().of(fsr::protocol::PacketType::kScan); }
  fsr::emulator::Emulator& board() { return *board_->operator->(); }
  void damage(const LineDamage& damage) { board().setDamage(damage); }
  test_support::TemporaryFolder folder_;
  std::string port_ = folder_.path("board");
  std::string capture_;
  test_support::SentPackets sent_;
  FaultListener listener_{sent_};
  std::unique_ptr<FaultBoard> board_;
  std::unique_ptr<fsr::protocol::BoardReader> reader_;
};

TEST_F(LinkFaults, CableOutAndInFiftyTimes) {
  ASSERT_TRUE(listener_.hears(10));
  LineDamage unplugged;
  unplugged.unplugged = true;
  for (int i = 0; i < 50; ++i) {
    damage(unplugged);
    ASSERT_TRUE(listener_.reaches(LinkPhase::kWaiting)) << "round " << i;
    damage({});
    ASSERT_TRUE(listener_.hears(3)) << "round " << i;
  }
  EXPECT_GE(reader_->report().connections, 51u);
  EXPECT_EQ(scanCounts().restarts, 0u);
}

TEST_F(LinkFaults, AResetBoardContinuesWithClockAndCountersFromZero) {
  ASSERT_TRUE(listener_.knows("A"));
  ASSERT_TRUE(board().waitForRigTime(1.5, kFaultPatience));  // a smaller step back does not count as a reset
  ASSERT_TRUE(listener_.hears(10));
  board().resetBoard();
  ASSERT_TRUE(listener_.hears(100));
  EXPECT_EQ(scanCounts().restarts, 1u);
}

TEST_F(LinkFaults, AnotherBoardOnThePortNeverPassesForTheFirst) {
  ASSERT_TRUE(listener_.knows("A"));
  for (const char* serial : {"B", "A", "B"}) {
    board_.reset();
    ASSERT_TRUE(listener_.reaches(LinkPhase::kWaiting));
    listener_.expectBoard(serial);
    start(serial);
    ASSERT_TRUE(listener_.knows(serial));
    ASSERT_TRUE(listener_.hears(10));
  }
}

TEST_F(LinkFaults, AWrongBaudRateGivesNoScanAndTheLinkContinues) {
  reader_.reset();
  start("A", 921600);
  ASSERT_TRUE(listener_.hears(20));
  LineDamage garbled;
  garbled.baud = 57600;
  damage(garbled);
  const std::uint64_t skipped = counts().skipped_bytes;
  ASSERT_TRUE(board().waitForRigTime(board().rigTime() + 0.5, kFaultPatience));
  EXPECT_GT(counts().skipped_bytes, skipped);
  damage({});
  ASSERT_TRUE(listener_.hears(50));
}

TEST_F(LinkFaults, AStreamOfNoiseGivesNoScanAndTheLinkContinues) {
  ASSERT_TRUE(listener_.hears(20));
  LineDamage noise;
  noise.lost_packets = 1;
  noise.noise = 20;
  damage(noise);
  const std::uint64_t heard = listener_.scans();
  const std::uint64_t target = counts().skipped_bytes + 100'000;
  ASSERT_TRUE(board().waitForRigTime(board().rigTime() + 0.1, kFaultPatience));
  while (counts().skipped_bytes < target)
    ASSERT_TRUE(board().waitForRigTime(board().rigTime() + 0.05, kFaultPatience));
  EXPECT_LE(listener_.scans(), heard + 300) << "those that were on their way";
  damage({});
  ASSERT_TRUE(listener_.hears(50));
}

TEST_F(LinkFaults, NoiseBetweenPacketsCostsNoPacket) {
  ASSERT_TRUE(listener_.hears(20));
  LineDamage noise;
  noise.noise = 2;
  damage(noise);
  ASSERT_TRUE(listener_.hears(300));
  damage({});
  ASSERT_TRUE(listener_.hears(20));
  // Only noise that looks like a header by chance (1 in 4 billion places) could cost a scan.
  EXPECT_EQ(scanCounts().lost, board().counts().dropped);
  EXPECT_GT(counts().skipped_bytes, 1000u);
}

TEST_F(LinkFaults, FlippedBitsAndLostBytesCostOnlyTheDamagedPackets) {
  ASSERT_TRUE(listener_.hears(20));
  LineDamage bad_line;
  bad_line.flipped_bits = 1e-3;
  bad_line.lost_bytes = 1e-3;
  damage(bad_line);
  ASSERT_TRUE(listener_.hears(500));
  damage({});
  ASSERT_TRUE(listener_.hears(20));
  const fsr::emulator::LinkCounts line = board().counts();
  EXPECT_GT(scanCounts().lost, 0u);
  EXPECT_LE(scanCounts().lost, line.damage.flipped_bits + line.damage.lost_bytes + line.dropped)
      << "an error costs one packet at most";
}

TEST_F(LinkFaults, DoubledPacketsAreDeliveredOnce) {
  ASSERT_TRUE(listener_.hears(20));
  LineDamage doubling;
  doubling.doubled_packets = 0.5;
  damage(doubling);
  const std::uint64_t gaps = scanCounts().gaps;
  ASSERT_TRUE(listener_.hears(300));
  EXPECT_GT(scanCounts().duplicates, 50u);
  EXPECT_EQ(scanCounts().gaps, gaps + 0u) << "and nothing is lost";
}

TEST_F(LinkFaults, LostPacketsAreCountedOneByOne) {
  ASSERT_TRUE(listener_.hears(20));
  LineDamage losing;
  losing.lost_packets = 0.3;
  damage(losing);
  ASSERT_TRUE(listener_.hears(300));
  damage({});
  ASSERT_TRUE(listener_.hears(50));
  const fsr::protocol::SequenceCounts scans = scanCounts();
  EXPECT_GT(scans.gaps, 30u);
  // Every scan between the first and the last one received was either received or counted as lost.
  EXPECT_LE(scans.packets + scans.lost, board().scans());
  const std::uint64_t made = board().scans();
  EXPECT_TRUE(listener_.await([&] {
    const fsr::protocol::SequenceCounts now = scanCounts();
    return now.packets + now.lost + board().counts().unheard >= made;
  })) << "all but what came before the port was opened";
}

TEST_F(LinkFaults, TheClockMayJumpEitherWay) {
  ASSERT_TRUE(listener_.knows("A"));
  for (const double jump : {30.0, -20.0, 600.0}) {
    board().jumpClock(jump);
    ASSERT_TRUE(listener_.hears(100)) << jump;
  }
  EXPECT_EQ(listener_.clockJumps(), 3u);
  EXPECT_EQ(scanCounts().lost, board().counts().dropped);
}

TEST_F(LinkFaults, TheClockMayWrapAround) {
  restart("A", 0, 0xFFFFFFFFu - 300'000u);  // 0.3 s before the end of its 32 bits
  ASSERT_TRUE(listener_.knows("A"));
  ASSERT_TRUE(board().waitForRigTime(0.6, kFaultPatience));
  ASSERT_TRUE(listener_.hears(50));
  EXPECT_EQ(scanCounts().restarts, 0u);
  EXPECT_EQ(listener_.clockJumps(), 0u);
}

TEST_F(LinkFaults, APauseCostsItsScansAndNoMore) {
  ASSERT_TRUE(listener_.hears(20));
  LineDamage silence;
  silence.pause = 0.5;
  damage(silence);
  ASSERT_TRUE(board().waitForRigTime(board().rigTime() + 0.6, kFaultPatience));
  ASSERT_TRUE(listener_.hears(20));
  EXPECT_EQ(scanCounts().gaps, 1u + (board().counts().dropped > 0 ? 1u : 0u));
  EXPECT_NEAR(static_cast<double>(scanCounts().lost - board().counts().dropped), 0.5 * 500, 3);
}

TEST_F(LinkFaults, AFullDiskEndsTheCaptureAndNotTheLink) {
  reader_.reset();
  capture_ = folder_.path("run.fsrcap");
  const test_support::FileSizeLimit disk(4096);
  start("A");
  ASSERT_TRUE(listener_.hears(500)) << "more than the disk takes";
  EXPECT_NE(reader_->report().capture_complaint.find(capture_), std::string::npos);
  EXPECT_LE(std::filesystem::file_size(capture_), 4096u);
  const std::uint64_t connections = reader_->report().connections;
  ASSERT_TRUE(listener_.hears(100));
  EXPECT_EQ(reader_->report().connections, connections);
}

TEST_F(LinkFaults, TwoSensorsAtOnceDoNotDisturbEachOther) {
  test_support::SentPackets other_sent;
  FaultBoard other(folder_.path("other"), other_sent, "Z");
  FaultListener other_listener(other_sent);
  const auto open = [this, &other] {
    return std::make_unique<fsr::protocol::SerialPort>(other->port(), 0, [this] { return now(); });
  };
  const fsr::protocol::BoardReader other_reader(open, other_listener, {std::chrono::milliseconds(5), ""});
  LineDamage bad_line;
  bad_line.flipped_bits = 1e-3;
  damage(bad_line);
  ASSERT_TRUE(listener_.hears(200));
  ASSERT_TRUE(other_listener.hears(200));
  EXPECT_EQ(other_listener.wrong().scans, 0u);
  EXPECT_EQ(other_reader.report().counts.skipped_bytes, 0u) << "the other line is whole";
}

}  // namespace
