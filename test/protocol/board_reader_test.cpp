#include "protocol/board_reader.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "fsr_pressure_map/settings/input_error.h"
#include "protocol/serial_port.h"
#include "support/packet_recorder.h"
#include "support/pty.h"

namespace {

using Bytes = std::vector<std::uint8_t>;
using fsr::protocol::LinkPhase;
using std::chrono::milliseconds;

constexpr std::chrono::seconds kPatience(20);  // never waited out where the code is right

Bytes reading(std::uint32_t sequence) {
  Bytes packet(64);
  packet.resize(fsr_wire_encode_transducer(packet.data(), packet.size(), sequence, sequence * 1000, 5));
  return packet;
}

// Notes all that a link says, for the test's thread to wait for.
class Listener : public fsr::protocol::LinkHandler {
 public:
  void onScan(const fsr::protocol::PacketHeader& header, const fsr::protocol::ScanPacket& scan) override {
    recorder_.onScan(header, scan);
  }
  void onTransducer(const fsr::protocol::PacketHeader& header, std::int32_t counts) override {
    add([&] { recorder_.onTransducer(header, counts); });
  }
  void onTemperature(const fsr::protocol::PacketHeader& header, std::int32_t value) override {
    recorder_.onTemperature(header, value);
  }
  void onIdentity(const fsr::protocol::PacketHeader& header,
                  const fsr::protocol::IdentityPacket& identity) override {
    recorder_.onIdentity(header, identity);
  }
  void onOpen(std::uint32_t) override {}
  void onBytes(std::int64_t) override {}
  void onChange(const fsr::protocol::LinkReport& report) override {
    add([&] { phases_.push_back(report.phase); });
  }

  // True once `count` packets came.
  bool packets(std::size_t count) {
    return await([&] { return recorder_.lines.size() >= count; });
  }
  // True once the link came to `phase`, after what an earlier call waited for.
  bool reaches(LinkPhase phase) {
    return await([&] {
      while (seen_ < phases_.size()) {
        if (phases_[seen_++] == phase) return true;
      }
      return false;
    });
  }
  std::size_t packetCount() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return recorder_.lines.size();
  }

 private:
  template <typename Do>
  void add(Do action) {
    const std::lock_guard<std::mutex> lock(mutex_);
    action();
    changed_.notify_all();
  }
  template <typename Condition>
  bool await(Condition condition) {
    std::unique_lock<std::mutex> lock(mutex_);
    return changed_.wait_for(lock, kPatience, condition);
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  test_support::PacketRecorder recorder_;
  std::vector<LinkPhase> phases_;
  std::size_t seen_ = 0;
};

class BoardReader : public testing::Test {
 protected:
  std::unique_ptr<fsr::protocol::BoardReader> makeLink(milliseconds reconnect_delay = milliseconds(1),
                                                       const std::string& capture = "") {
    const auto open = [this] {
      return std::make_unique<fsr::protocol::SerialPort>(port_, 115200, [this] { return now_.load(); });
    };
    return std::make_unique<fsr::protocol::BoardReader>(
        open, listener_, fsr::protocol::BoardReader::Options{reconnect_delay, capture});
  }
  void plugIn() { board_ = std::make_unique<test_support::Pty>(port_); }

  test_support::TemporaryFolder folder_;
  std::string port_ = folder_.path("ttyBoard");
  std::atomic<std::int64_t> now_{1};
  std::unique_ptr<test_support::Pty> board_;
  Listener listener_;
};

TEST_F(BoardReader, ReadsTheBoard) {
  plugIn();
  const auto link = makeLink();
  ASSERT_TRUE(listener_.reaches(LinkPhase::kReading));
  board_->write(reading(1));
  ASSERT_TRUE(listener_.packets(1));
  EXPECT_EQ(link->report().phase, LinkPhase::kReading);
  EXPECT_EQ(link->report().connections, 1U);
}

TEST_F(BoardReader, SaysWhyItWaitsAndStartsWhenTheBoardComes) {
  const auto link = makeLink();
  ASSERT_TRUE(listener_.reaches(LinkPhase::kWaiting));
  EXPECT_NE(link->report().reason.find("there is no serial port " + port_), std::string::npos)
      << link->report().reason;
  plugIn();
  ASSERT_TRUE(listener_.reaches(LinkPhase::kReading));
  EXPECT_EQ(link->report().reason, "");
  board_->write(reading(1));
  EXPECT_TRUE(listener_.packets(1));
}

TEST_F(BoardReader, SurvivesUnpluggingAsOftenAsItHappens) {
  const auto link = makeLink();
  for (std::uint32_t round = 1; round <= 3; ++round) {
    plugIn();
    ASSERT_TRUE(listener_.reaches(LinkPhase::kReading));
    board_->write(reading(1000 * round));
    ASSERT_TRUE(listener_.packets(round));
    board_.reset();
    ASSERT_TRUE(listener_.reaches(LinkPhase::kWaiting));
  }
  EXPECT_EQ(link->report().connections, 3U);
  EXPECT_EQ(link->report().counts.of(FSR_WIRE_TRANSDUCER).gaps, 0U) << "an outage is no gap in the stream";
}

TEST_F(BoardReader, ClosesThePortWhenDisabledAndOpensItAgain) {
  plugIn();
  const auto link = makeLink();
  ASSERT_TRUE(listener_.reaches(LinkPhase::kReading));
  link->setEnabled(false);
  ASSERT_TRUE(listener_.reaches(LinkPhase::kDisabled));
  EXPECT_NO_THROW(fsr::protocol::SerialPort(port_, 115200, [] { return 1; }))
      << "the port is free for others";
  link->setEnabled(true);
  ASSERT_TRUE(listener_.reaches(LinkPhase::kReading));
  board_->write(reading(1));
  EXPECT_TRUE(listener_.packets(1));
}

TEST_F(BoardReader, EndsAtOnceWhileItWaits) {
  auto link = makeLink(std::chrono::hours(1));
  ASSERT_TRUE(listener_.reaches(LinkPhase::kWaiting));
  link.reset();
}

TEST_F(BoardReader, DropsBytesUntilTheHostsTimeRuns) {
  now_ = 0;
  plugIn();
  const auto link = makeLink();
  ASSERT_TRUE(listener_.reaches(LinkPhase::kReading));
  board_->write(reading(1));
  ASSERT_TRUE(listener_.reaches(LinkPhase::kNoTime));
  now_ = 1000;
  board_->write(reading(2));
  ASSERT_TRUE(listener_.packets(1));
  EXPECT_EQ(listener_.packetCount(), 1U);
  EXPECT_EQ(link->report().phase, LinkPhase::kReading);
}

TEST_F(BoardReader, KeepsACaptureThatReplaysToTheSamePackets) {
  const std::string capture = folder_.path("run.fsrcap");
  plugIn();
  {
    const auto link = makeLink(milliseconds(1), capture);
    ASSERT_TRUE(listener_.reaches(LinkPhase::kReading));
    for (std::uint32_t i = 0; i < 50; ++i) board_->write(reading(i));
    ASSERT_TRUE(listener_.packets(50));
  }
  Listener replayed;
  const auto open = [&] { return std::make_unique<fsr::protocol::CaptureReader>(capture); };
  const fsr::protocol::BoardReader link(open, replayed, {milliseconds(1), ""});
  ASSERT_TRUE(replayed.reaches(LinkPhase::kEnded));
  EXPECT_EQ(replayed.packetCount(), 50U);
  EXPECT_EQ(link.report().counts.skipped_bytes, 0U);
}

TEST_F(BoardReader, RefusesToStartOnACaptureThatExists) {
  const std::string capture = folder_.path("run.fsrcap");
  const fsr::protocol::CaptureWriter first(capture);
  EXPECT_THROW(makeLink(milliseconds(1), capture), fsr::settings::InputError);
}

}  // namespace
