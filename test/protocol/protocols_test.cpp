#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "fsr_pressure_map/protocol/decoder.h"
#include "fsr_pressure_map/protocol/wire.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "protocol/board_reader.h"
#include "protocol/serial_port.h"
#include "support/dummy_protocol.h"
#include "support/holds.h"
#include "support/link_listener.h"
#include "support/packet_recorder.h"
#include "support/pty.h"

namespace {

using fsr::protocol::PacketType;
using test_support::DummyDecoder;

TEST(Protocols, MakeTheDecoderOfTheWireFormatByItsNameAndByDefault) {
  std::vector<std::uint8_t> bytes(64);
  bytes.resize(fsr_wire_encode_transducer(bytes.data(), bytes.size(), 7, 1000, -2));
  for (const auto make :
       {fsr::protocol::protocols().front().make, fsr::protocol::protocolNamed("wire").make}) {
    test_support::PacketRecorder recorder;
    make(recorder, {})->feed(bytes.data(), bytes.size());
    EXPECT_EQ(recorder.lines, std::vector<std::string>{"transducer #7 @1000 -2"});
  }
}

TEST(Protocols, HaveANameAndASummaryEach) {
  for (const fsr::protocol::Protocol& protocol : fsr::protocol::protocols()) {
    EXPECT_EQ(&fsr::protocol::protocolNamed(protocol.name), &protocol) << "another one has this name";
    EXPECT_FALSE(protocol.summary.empty()) << protocol.name;
  }
}

TEST(Protocols, AreListedWhereANameIsUnknown) {
  EXPECT_TRUE(test_support::holds(test_support::refusal([&] { fsr::protocol::protocolNamed("morse"); }),
                                  {"there is no protocol morse"}));
}

// What CONTRIBUTING.md promises: a protocol is a decoder and its maker, and nothing behind them changes.
TEST(Protocols, AnotherOneRunsThroughTheBoardReaderAndCountsItsDamage) {
  const test_support::TemporaryFolder folder;
  const std::string port = folder.path("ttyBoard");
  auto board = std::make_unique<test_support::Pty>(port);
  test_support::LinkListener listener;
  fsr::protocol::BoardReader::Options options;
  options.make_decoder = DummyDecoder::make;
  const fsr::protocol::BoardReader reader(
      [&] { return std::make_unique<fsr::protocol::SerialPort>(port, 0, [] { return 1; }); }, listener,
      options);
  ASSERT_TRUE(listener.reaches(fsr::protocol::LinkPhase::kReading));

  std::vector<std::uint8_t> damaged = DummyDecoder::frame(2, 200);
  damaged[3] ^= 1U;
  board->write({1, 2, 3});  // noise
  board->write(DummyDecoder::frame(1, 100));
  board->write(damaged);
  board->write(DummyDecoder::frame(5, 0x0123));
  ASSERT_TRUE(listener.packets(2));
  board.reset();
  ASSERT_TRUE(listener.reaches(fsr::protocol::LinkPhase::kWaiting));

  const std::vector<std::string> expected = {"scan #1 @1000 1x1 full 65535 took 0 counts 100",
                                             "scan #5 @5000 1x1 full 65535 took 0 counts 291"};
  EXPECT_EQ(listener.lines(), expected);
  const fsr::protocol::DecoderCounts counts = reader.report().counts;
  EXPECT_EQ(counts.bad_packet_check, 1U);
  EXPECT_EQ(counts.skipped_bytes, 3U + 5U);
  EXPECT_EQ(counts.of(PacketType::kScan).packets, 2U);
  EXPECT_EQ(counts.of(PacketType::kScan).lost, 3U);
}

}  // namespace
