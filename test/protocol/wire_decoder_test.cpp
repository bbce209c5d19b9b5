#include "protocol/wire_decoder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "support/packet_recorder.h"

namespace {

using Bytes = std::vector<std::uint8_t>;
using Lines = std::vector<std::string>;
using Buffer = std::array<std::uint8_t, FSR_WIRE_MAX_PACKET>;

Bytes operator+(Bytes a, const Bytes& b) {
  std::copy(b.begin(), b.end(), std::back_inserter(a));
  return a;
}

Bytes scan(std::uint32_t sequence, std::uint32_t time, const std::vector<std::uint16_t>& counts,
           std::uint16_t full_scale = 4095) {
  Buffer out;
  const fsr_wire_scan content = {1, static_cast<std::uint8_t>(counts.size()), full_scale, 5000,
                                 counts.data()};
  return {out.data(), out.data() + fsr_wire_encode_scan(out.data(), out.size(), sequence, time, &content)};
}

Bytes transducer(std::uint32_t sequence, std::uint32_t time, std::int32_t counts) {
  Buffer out;
  return {out.data(),
          out.data() + fsr_wire_encode_transducer(out.data(), out.size(), sequence, time, counts)};
}

Bytes temperature(std::uint32_t sequence, std::uint32_t time, std::int32_t millidegrees) {
  Buffer out;
  return {out.data(),
          out.data() + fsr_wire_encode_temperature(out.data(), out.size(), sequence, time, millidegrees)};
}

Bytes trigger(std::uint32_t sequence, std::uint32_t time, std::uint8_t high, std::uint32_t deviation) {
  Buffer out;
  return {out.data(),
          out.data() + fsr_wire_encode_trigger(out.data(), out.size(), sequence, time, high, deviation)};
}

Bytes identity(std::uint8_t rows = 7) {
  Buffer out;
  const fsr_wire_identity content = {"FSR-0042", "1.2.0", "rig board", rows, 10, 4095, 10000};
  return {out.data(), out.data() + fsr_wire_encode_identity(out.data(), out.size(), 2, 2000000, &content)};
}

// Overwrites the header of a packet and recomputes the checks: a valid packet with unusual content.
Bytes withHeader(Bytes packet, std::uint8_t version, std::uint8_t type, std::uint16_t length) {
  packet[2] = version;
  packet[3] = type;
  packet[4] = static_cast<std::uint8_t>(length & 0xFF);
  packet[5] = static_cast<std::uint8_t>(length >> 8);
  const std::uint16_t check = fsr_wire_crc16(packet.data() + 2, 12);
  packet[14] = static_cast<std::uint8_t>(check & 0xFF);
  packet[15] = static_cast<std::uint8_t>(check >> 8);
  const std::uint32_t whole = fsr_wire_crc32(packet.data() + 2, packet.size() - 6);
  for (int i = 0; i < 4; ++i) packet[packet.size() - 4 + i] = static_cast<std::uint8_t>(whole >> (8 * i));
  return packet;
}

// A decoder and the packets that it delivered.
struct Bench {
  test_support::PacketRecorder recorder;
  fsr::protocol::WireDecoder decoder{recorder};

  Bench& feed(const Bytes& bytes) {
    decoder.feed(bytes.data(), bytes.size());
    return *this;
  }
  const Lines& lines() const { return recorder.lines; }
  const fsr::protocol::DecoderCounts& counts() const { return decoder.counts(); }
};

Lines linesOf(const Bytes& bytes) {
  Bench bench;
  bench.feed(bytes).decoder.finish();
  return bench.lines();
}

// One packet of each type and a second scan. The exhaustive tests damage this stream.
std::vector<Bytes> fivePackets() {
  return {scan(7, 1000, {0, 1, 258, 0x0AAA, 4094, 4095}), transducer(40, 2000, -2), identity(),
          temperature(1, 3000, 23750), scan(8, 11000, {5, 6, 7, 8, 9, 10})};
}

Bytes joined(const std::vector<Bytes>& packets) {
  Bytes stream;
  for (const Bytes& packet : packets) stream = stream + packet;
  return stream;
}

const std::string kFirstScan = "scan #7 @1000 1x6 full 4095 took 5000 counts 0 1 258 2730 4094 4095";
const Lines kFiveLines = {kFirstScan, "transducer #40 @2000 -2",
                          "identity #2 @2000000 FSR-0042/1.2.0/rig board 7x10 full 4095 every 10000",
                          "temperature #1 @3000 23750",
                          "scan #8 @11000 1x6 full 4095 took 5000 counts 5 6 7 8 9 10"};

TEST(WireDecoder, ReadsEveryFieldOfAScanFromLiteralBytes) {
  // The packet of docs/wire_format.md, see wire_test.cpp for the Python line that made it.
  const Bytes bytes = {0xA5, 0x5A, 0x01, 0x01, 0x14, 0x00, 0x07, 0x00, 0x00, 0x00, 0x15, 0xCD, 0x5B, 0x07,
                       0x98, 0xC0, 0x02, 0x03, 0xFF, 0x0F, 0x88, 0x13, 0x00, 0x00, 0x00, 0x00, 0x01, 0x00,
                       0x02, 0x01, 0xAA, 0x0A, 0xFE, 0x0F, 0xFF, 0x0F, 0x09, 0x94, 0x49, 0x66};
  const Lines expected = {"scan #7 @123456789 2x3 full 4095 took 5000 counts 0 1 258 2730 4094 4095"};
  EXPECT_EQ(linesOf(bytes), expected);
}

TEST(WireDecoder, ReadsTheSamePacketsInChunksOfAnySize) {
  const Bytes stream = joined(fivePackets());
  for (std::size_t chunk = 1; chunk < stream.size(); ++chunk) {
    Bench bench;
    for (std::size_t at = 0; at < stream.size(); at += chunk) {
      bench.decoder.feed(stream.data() + at, std::min(chunk, stream.size() - at));
    }
    ASSERT_EQ(bench.lines(), kFiveLines) << "chunks of " << chunk;
  }
}

TEST(WireDecoder, DeliversAPacketWithItsLastByteAndNotBefore) {
  const Bytes packet = fivePackets().front();
  Bench bench;
  bench.feed({packet.begin(), packet.end() - 1});
  EXPECT_TRUE(bench.lines().empty());
  bench.feed({packet.back()});
  EXPECT_EQ(bench.lines(), Lines{kFirstScan});
}

TEST(WireDecoder, LosesOnlyThePacketThatWasCutShortAtAnyByte) {
  const std::vector<Bytes> packets = fivePackets();
  for (std::size_t victim = 0; victim < packets.size(); ++victim) {
    Lines expected = kFiveLines;
    expected.erase(expected.begin() + victim);
    for (std::size_t kept = 0; kept < packets[victim].size(); ++kept) {
      std::vector<Bytes> damaged = packets;
      damaged[victim].resize(kept);
      ASSERT_EQ(linesOf(joined(damaged)), expected)
          << "packet " << victim << " cut after " << kept << " bytes";
    }
  }
}

TEST(WireDecoder, LosesOnlyThePacketThatAFlippedBitHits) {
  const std::vector<Bytes> packets = fivePackets();
  for (std::size_t victim = 0; victim < packets.size(); ++victim) {
    Lines expected = kFiveLines;
    expected.erase(expected.begin() + victim);
    for (std::size_t bit = 0; bit < 8 * packets[victim].size(); ++bit) {
      std::vector<Bytes> damaged = packets;
      damaged[victim][bit / 8] ^= static_cast<std::uint8_t>(1U << (bit % 8));
      ASSERT_EQ(linesOf(joined(damaged)), expected) << "packet " << victim << " bit " << bit;
    }
  }
}

TEST(WireDecoder, LosesOnlyThePacketThatAnInsertedByteHits) {
  const std::vector<Bytes> packets = fivePackets();
  for (std::size_t at = 1; at < packets[0].size(); ++at) {
    for (const int inserted : {0x00, 0xA5, 0x5A, 0xFF}) {
      std::vector<Bytes> damaged = packets;
      damaged[0] = Bytes(packets[0].begin(), packets[0].begin() + at) +
                   Bytes{static_cast<std::uint8_t>(inserted)} +
                   Bytes(packets[0].begin() + at, packets[0].end());
      const Lines lines = linesOf(joined(damaged));
      // A byte inserted before or behind an equal one gives the same bytes, so the first packet may survive.
      ASSERT_EQ(Lines(lines.end() - 4, lines.end()), Lines(kFiveLines.begin() + 1, kFiveLines.end())) << at;
    }
  }
}

TEST(WireDecoder, DoesNotWaitForTheLengthOfADamagedHeader) {
  Bytes huge = fivePackets().front();
  huge[5] = 0x20;  // length 20 becomes 8,212
  Bench bench;
  bench.feed(huge + transducer(40, 2000, -2));
  EXPECT_EQ(bench.lines(), Lines{"transducer #40 @2000 -2"});
  EXPECT_EQ(bench.counts().bad_header_check, 1U);
}

TEST(WireDecoder, CountsDamageByItsCause) {
  const Bytes whole = transducer(40, 2000, -2);
  Bytes bad_check = whole;
  bad_check.back() ^= 1U;
  Bench bench;
  bench.feed(bad_check).feed(withHeader(whole, 2, FSR_WIRE_TRANSDUCER, 4)).feed(withHeader(whole, 1, 9, 4));
  const std::vector<std::uint16_t> impossible_for_a_scan = {8, 13, FSR_WIRE_MAX_PAYLOAD + 2, 65534};
  for (const std::uint16_t length : impossible_for_a_scan)
    bench.feed(withHeader(whole, 1, FSR_WIRE_SCAN, length));
  bench.feed(withHeader(whole, 1, FSR_WIRE_TRANSDUCER, 5));
  EXPECT_EQ(bench.lines(), Lines{});
  EXPECT_EQ(bench.counts().bad_packet_check, 1U);
  EXPECT_EQ(bench.counts().unknown_version, 1U);
  EXPECT_EQ(bench.counts().unknown_type, 1U);
  EXPECT_EQ(bench.counts().bad_length, 5U);
  EXPECT_EQ(bench.counts().skipped_bytes, 8 * whole.size());
  EXPECT_EQ(bench.counts().bytes, 8 * whole.size());
}

TEST(WireDecoder, RefusesValidPacketsWithImpossibleContent) {
  Bytes no_rows = scan(1, 1000, {1, 2});
  no_rows[16] = 0;
  Bytes other_size = scan(2, 1000, {1, 2});
  other_size[17] = 3;
  Bytes above_full_scale = scan(3, 1000, {4096, 2});
  Bench bench;
  for (const Bytes& packet : {no_rows, other_size, above_full_scale}) {
    bench.feed(withHeader(packet, 1, FSR_WIRE_SCAN, 12));
  }
  bench.feed(identity(65));
  EXPECT_EQ(bench.lines(), Lines{});
  EXPECT_EQ(bench.counts().bad_content, 4U);
  EXPECT_EQ(bench.feed(transducer(1, 1, 1)).lines().size(), 1U);
}

TEST(WireDecoder, ReadsSyncBytesAndWholePacketsInsideAPayload) {
  // A payload made of a transducer packet and of sync words, and counts of 16 bits.
  const Bytes inner = transducer(1, 2, 3) + Bytes{0xA5, 0x5A, 0xA5, 0xA5, 0x5A, 0x5A};
  std::vector<std::uint16_t> counts;
  for (std::size_t i = 0; i < inner.size(); i += 2) {
    counts.push_back(static_cast<std::uint16_t>(inner[i] | (inner[i + 1] << 8)));
  }
  Bench bench;
  bench.feed(scan(1, 1000, counts, 65535) + transducer(9, 9, 9));
  ASSERT_EQ(bench.lines().size(), 2U);
  EXPECT_EQ(bench.lines()[0].substr(0, 12), "scan #1 @100");
  EXPECT_EQ(bench.lines()[1], "transducer #9 @9 9");
  EXPECT_EQ(bench.counts().skipped_bytes, 0U);
}

TEST(WireDecoder, ReadsTheLargestScanBehindTheLargestDamagedOne) {
  std::vector<std::uint16_t> counts(64 * 64);
  for (std::size_t i = 0; i < counts.size(); ++i) counts[i] = static_cast<std::uint16_t>(i);
  const fsr_wire_scan content = {64, 64, 4095, 0, counts.data()};
  Buffer out;
  ASSERT_EQ(fsr_wire_encode_scan(out.data(), out.size(), 1, 1, &content), out.size());
  Bytes damaged(out.begin(), out.end());
  damaged[5000] ^= 0x10U;
  Bench bench;
  bench.feed(damaged + Bytes(out.begin(), out.end()));
  ASSERT_EQ(bench.lines().size(), 1U);
  EXPECT_EQ(bench.lines()[0].substr(bench.lines()[0].size() - 10), " 4094 4095");
}

TEST(WireDecoder, FindsNothingInRandomNoise) {
  // A false packet needs a match of sync, version, type, length and 48 bits of checks: below 1e-16 in 8 MB.
  std::mt19937 random(1);
  Bytes noise(std::size_t{1} << 23);
  std::generate(noise.begin(), noise.end(), [&] { return static_cast<std::uint8_t>(random() >> 24); });
  Bench bench;
  bench.feed(noise);
  EXPECT_EQ(bench.lines(), Lines{});
  // 2^23 places, each a sync word with probability 2^-16: 128 expected, 6 deviations (68) on either side.
  EXPECT_NEAR(static_cast<double>(bench.counts().bad_header_check), 128, 68);
  EXPECT_EQ(bench.feed(joined(fivePackets())).lines(), kFiveLines);
}

TEST(WireDecoder, ReadsTriggersBetweenScansAndRefusesAnotherLevelThanTwo) {
  Bench bench;
  bench.feed(trigger(5, 1000, 1, 2) + scan(7, 1500, {1}) + trigger(6, 2000, 0, 70000));
  const Lines expected = {"trigger #5 @1000 rising +- 2", "scan #7 @1500 1x1 full 4095 took 5000 counts 1",
                          "trigger #6 @2000 falling +- 70000"};
  EXPECT_EQ(bench.lines(), expected);
  Bytes other = trigger(7, 3000, 1, 2);
  other[FSR_WIRE_HEADER_SIZE] = 2;
  EXPECT_EQ(bench.feed(withHeader(other, 1, 5, 5)).lines(), expected);
  EXPECT_EQ(bench.counts().bad_content, 1U);
}

// As a driver meets a packet type that it does not know yet.
TEST(WireDecoder, ReadsOnBehindATypeThatItDoesNotKnow) {
  Bench bench;
  bench.feed(scan(1, 1000, {1}) + withHeader(trigger(1, 1500, 1, 2), 1, 6, 5) + scan(2, 2000, {1}));
  EXPECT_EQ(bench.lines().size(), 2U);
  EXPECT_EQ(bench.counts().unknown_type, 1U);
  EXPECT_EQ(bench.counts().of(fsr::protocol::PacketType::kScan).lost, 0U);
}

TEST(WireDecoder, CountsGapsDuplicatesAndRestartsOfEachTypeOnItsOwn) {
  Bench bench;
  for (const std::uint32_t sequence : {10, 11, 14, 14, 15, 0, 1}) {
    bench.feed(scan(sequence, sequence * 1000, {1})).feed(transducer(0xFFFFFFFE + sequence, sequence, 0));
  }
  const fsr::protocol::SequenceCounts& scans = bench.counts().of(fsr::protocol::PacketType::kScan);
  EXPECT_EQ(scans.packets, 6U);
  EXPECT_EQ(scans.gaps, 1U);
  EXPECT_EQ(scans.lost, 2U);
  EXPECT_EQ(scans.duplicates, 1U);
  EXPECT_EQ(scans.restarts, 1U);
  EXPECT_EQ(bench.counts().of(fsr::protocol::PacketType::kTemperature).packets, 0U);
}

TEST(WireDecoder, CountsNoGapWhereTheCounterWraps) {
  Bench bench;
  for (const std::uint32_t sequence : {0xFFFFFFFEU, 0xFFFFFFFFU, 0U, 1U})
    bench.feed(transducer(sequence, sequence, 0));
  EXPECT_EQ(bench.counts().of(fsr::protocol::PacketType::kTransducer).packets, 4U);
  EXPECT_EQ(bench.counts().of(fsr::protocol::PacketType::kTransducer).gaps, 0U);
  EXPECT_EQ(bench.counts().of(fsr::protocol::PacketType::kTransducer).restarts, 0U);
}

TEST(WireDecoder, CountsNoGapAcrossTheEndOfAStream) {
  Bench bench;
  bench.feed(transducer(1, 1, 0) + Bytes{0xA5, 0x5A, 0x01}).decoder.finish();
  bench.feed(transducer(100, 1, 0));
  EXPECT_EQ(bench.lines().size(), 2U);
  EXPECT_EQ(bench.counts().of(fsr::protocol::PacketType::kTransducer).gaps, 0U);
  EXPECT_EQ(bench.counts().skipped_bytes, 3U);
}

}  // namespace
