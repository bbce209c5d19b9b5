#include "emulator/board.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "protocol/wire_decoder.h"
#include "simulation/settings_text.h"
#include "support/packet_recorder.h"
#include "support/source_dir.h"

namespace {

using fsr::emulator::Board;

fsr::simulation::SimulationSettings smallRig(const std::string& board) {
  return fsr::simulation::readSimulation(
      fsr::settings::Settings::fromText("{simulation: t, matrix: {rows: 1, columns: 2}, board: " + board +
                                            ", effects: {static_curve: {}, converter: {}}}",
                                        "test.yaml"));
}

std::vector<std::string> packetsUntil(Board& board, double end) {
  test_support::PacketRecorder recorder;
  fsr::protocol::WireDecoder decoder(recorder);
  while (board.nextDue() <= end) {
    const auto& packet = board.next([](double) { return 0.0; });
    decoder.feed(packet.data(), packet.size());
  }
  return recorder.lines;
}

TEST(Board, SendsEachKindAtItsOwnRate) {
  Board board(smallRig("{serial: A7, model: m, scan_rate: 4, transducer_rate: 2}, climate: {room: 21.5}"),
              {});
  const std::vector<std::string> expected = {
      "identity #0 @0 A7/1.0.0/m 1x2 full 4095 every 250000",
      "temperature #0 @0 21500",
      "transducer #0 @0 371",
      "scan #0 @0 1x2 full 4095 took 0 counts 0 0",
      "scan #1 @250000 1x2 full 4095 took 0 counts 0 0",
      "transducer #1 @500000 371",
      "scan #2 @500000 1x2 full 4095 took 0 counts 0 0",
      "scan #3 @750000 1x2 full 4095 took 0 counts 0 0",
  };
  EXPECT_EQ(packetsUntil(board, 0.99), expected);
}

TEST(Board, StampsAScanWithItsMiddleAndSendsItAtTheEnd) {
  Board board(smallRig("{scan_rate: 10, scan_duration: 0.08, transducer_rate: 0}"), {});
  EXPECT_EQ(packetsUntil(board, 0.039).size(), 2u);  // identity and temperature
  EXPECT_EQ(packetsUntil(board, 0.041).front(), "scan #0 @0 1x2 full 4095 took 80000 counts 0 0");
}

TEST(Board, HasAClockWithOffsetAndDriftThatWrapsInPackets) {
  Board board(smallRig("{scan_rate: 1, transducer_rate: 0}"), {4294000000u, 100});
  EXPECT_EQ(board.deviceTime(10), 4294000000u + std::uint64_t{10001000});
  EXPECT_NEAR(board.rigTime(board.deviceTime(10)), 10, 1e-6);
  const auto lines = packetsUntil(board, 1);
  // 4294000000 + 1000100 - 2^32
  EXPECT_EQ(lines.back(), "scan #1 @32804 1x2 full 4095 took 0 counts 0 0");
}

TEST(Board, SendsAnEdgeOfItsTriggerAtOnce) {
  Board board(smallRig("{scan_rate: 4, transducer_rate: 0}"), {});
  packetsUntil(board, 0.3);
  board.setTrigger(true, 0.31);
  const std::vector<std::string> expected = {"trigger #0 @310000 rising +- 1",
                                             "scan #2 @500000 1x2 full 4095 took 0 counts 0 0"};
  EXPECT_EQ(packetsUntil(board, 0.5), expected);
  board.setTrigger(false, 0.6);
  EXPECT_EQ(packetsUntil(board, 0.6).front(), "trigger #1 @600000 falling +- 1");
}

TEST(Board, StartsAgainWhenReset) {
  Board board(smallRig("{scan_rate: 2, transducer_rate: 0, serial: A7, model: m}"), {});
  packetsUntil(board, 10.2);
  board.reset(10.3);
  const std::vector<std::string> expected = {"identity #0 @0 A7/1.0.0/m 1x2 full 4095 every 500000",
                                             "scan #0 @200000 1x2 full 4095 took 0 counts 0 0"};
  EXPECT_EQ(packetsUntil(board, 10.5), expected);
  EXPECT_NEAR(board.rigTime(200000), 10.5, 1e-9);
}

TEST(Board, ReadsZeroWhereATaxelHasNoContact) {
  Board board(smallRig("{scan_rate: 2, transducer_rate: 0}"), {});
  const auto full = [](double) { return 600e3; };
  test_support::PacketRecorder recorder;
  fsr::protocol::WireDecoder decoder(recorder);
  const auto lastScan = [&] {
    for (int i = 0; i < 6; ++i) {
      const auto& packet = board.next(full);
      decoder.feed(packet.data(), packet.size());
    }
    const auto scan = std::find_if(recorder.lines.rbegin(), recorder.lines.rend(),
                                   [](const std::string& line) { return line.rfind("scan", 0) == 0; });
    return scan->substr(scan->find("counts"));
  };
  const std::string whole = lastScan();
  EXPECT_EQ(whole.find(" 0"), std::string::npos) << whole;
  board.loseTaxel(1);
  const std::string lost = lastScan();
  EXPECT_EQ(lost, whole.substr(0, whole.rfind(' ')) + " 0");
  board.fixTaxels();
  EXPECT_EQ(lastScan(), whole);
}

TEST(Board, ReadsTheLowerEndOfTheRangeOfATransducerThatIsUnplugged) {
  Board board(smallRig("{scan_rate: 0.1, transducer_rate: 2}"), {});
  packetsUntil(board, 0.1);
  board.setTransducer(Board::TransducerLine::kUnplugged, 0.2);
  EXPECT_EQ(packetsUntil(board, 0.7), std::vector<std::string>{"transducer #1 @500000 0"});
  board.setTransducer(Board::TransducerLine::kWorks, 0.8);
  EXPECT_EQ(packetsUntil(board, 1.7).back(), "transducer #3 @1500000 371");
}

TEST(Board, SendsNoReadingsOfATransducerThatIsOffAndNoneLate) {
  Board board(smallRig("{scan_rate: 0.1, transducer_rate: 2}"), {});
  packetsUntil(board, 0.1);
  board.setTransducer(Board::TransducerLine::kSilent, 0.2);
  for (const std::string& packet : packetsUntil(board, 4.8)) {
    EXPECT_EQ(packet.find("transducer"), std::string::npos) << packet;
  }
  board.setTransducer(Board::TransducerLine::kWorks, 4.8);
  packetsUntil(board, 5.1);
  EXPECT_EQ(packetsUntil(board, 5.7), std::vector<std::string>{"transducer #2 @5500000 371"});
}

TEST(Board, ComputesTheBitRateOfItsLink) {
  // 10 bits a byte; a scan of 7 x 10 is 168 bytes, a transducer or temperature packet 24, identity 76.
  const auto demo =
      fsr::simulation::readSimulationFile(test_support::sourceDir() + "/config/simulation/demo.yaml");
  EXPECT_NEAR(Board(demo, {}).bitsPerSecond(), 10 * (10 * 168 + 10 * 24 + 24 + 76), 1e-9);
}

}  // namespace
