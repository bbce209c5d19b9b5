#include "protocol/board_reader.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "fsr_pressure_map/protocol/wire.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "protocol/serial_port.h"
#include "support/holds.h"
#include "support/link_listener.h"
#include "support/pty.h"

namespace {

using Bytes = std::vector<std::uint8_t>;
using fsr::protocol::LinkPhase;
using std::chrono::milliseconds;

Bytes reading(std::uint32_t sequence) {
  Bytes packet(64);
  packet.resize(fsr_wire_encode_transducer(packet.data(), packet.size(), sequence, sequence * 1000, 5));
  return packet;
}

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
  test_support::LinkListener listener_;
};

TEST_F(BoardReader, ReportsWhyItWaitsAndStartsWhenTheBoardIsPluggedIn) {
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

TEST_F(BoardReader, SurvivesRepeatedUnplugging) {
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
  EXPECT_EQ(link->report().counts.of(fsr::protocol::PacketType::kTransducer).gaps, 0U)
      << "an outage is no gap in the stream";
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
  test_support::LinkListener replayed;
  const auto open = [&] { return std::make_unique<fsr::protocol::CaptureReader>(capture); };
  const fsr::protocol::BoardReader link(open, replayed, {milliseconds(1), ""});
  ASSERT_TRUE(replayed.reaches(LinkPhase::kEnded));
  EXPECT_EQ(replayed.packetCount(), 50U);
  EXPECT_EQ(link.report().counts.skipped_bytes, 0U);
}

TEST_F(BoardReader, ReportsAnExceptionOfTheHandlerAsItsFaultAndKeepsTheLink) {
  listener_.before_transducer = [](const fsr::protocol::PacketHeader& header) {
    if (header.sequence == 2) throw std::runtime_error("no room for reading 2");
  };
  plugIn();
  const auto link = makeLink();
  ASSERT_TRUE(listener_.reaches(LinkPhase::kReading));
  board_->write(reading(1));
  board_->write(reading(2));
  board_->write(reading(3));
  ASSERT_TRUE(listener_.packets(2)) << "readings 1 and 3";
  ASSERT_TRUE(listener_.complains());
  const fsr::protocol::LinkReport report = link->report();
  EXPECT_EQ(report.phase, LinkPhase::kReading);
  EXPECT_EQ(report.reason, "") << "nothing is wrong with the port";
  EXPECT_EQ(report.connections, 1U);
  EXPECT_EQ(report.handler_faults, 1U);
  EXPECT_TRUE(test_support::holds(report.handler_complaint,
                                  {"a transducer reading", "not on the link", "no room for reading 2"}));
}

TEST_F(BoardReader, KeepsTheLinkWhateverTheHandlerThrows) {
  listener_.before_open = [] { throw 1; };
  listener_.before_bytes = [] { throw std::runtime_error("bytes"); };
  listener_.before_change = [] { throw std::runtime_error("change"); };
  plugIn();
  const auto link = makeLink();
  ASSERT_TRUE(listener_.reaches(LinkPhase::kReading));
  board_->write(reading(1));
  ASSERT_TRUE(listener_.packets(1));
  EXPECT_EQ(link->report().phase, LinkPhase::kReading);
  EXPECT_EQ(link->report().connections, 1U);
  EXPECT_GE(link->report().handler_faults, 2U) << "of onOpen() and of onChange()";
}

TEST_F(BoardReader, RefusesToStartOnACaptureThatExists) {
  const std::string capture = folder_.path("run.fsrcap");
  const fsr::protocol::CaptureWriter first(capture);
  EXPECT_THROW(makeLink(milliseconds(1), capture), fsr::settings::InputError);
}

}  // namespace
