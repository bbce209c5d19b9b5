#include "protocol/text_decoder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include "fsr_pressure_map/settings/input_error.h"
#include "support/holds.h"
#include "support/packet_recorder.h"

namespace {

using fsr::protocol::DecoderOptions;
using fsr::protocol::LineCounts;
using fsr::protocol::PacketType;
using Lines = std::vector<std::string>;

// A board of 1 x 3 taxels that prints milliseconds.
DecoderOptions options(bool transducer = false, std::uint32_t tick = 1000) {
  return {{1, 3}, 1023, tick, transducer};
}

// A decoder and the packets that it delivered.
struct TextBench {
  test_support::PacketRecorder recorder;
  fsr::protocol::TextDecoder decoder;

  explicit TextBench(const DecoderOptions& options = ::options()) : decoder(recorder, options) {}

  TextBench& feed(const std::string& text) {
    const std::vector<std::uint8_t> bytes(text.begin(), text.end());
    decoder.feed(bytes.data(), bytes.size());
    return *this;
  }
  const Lines& lines() const { return recorder.lines; }
  const fsr::protocol::DecoderCounts& counts() const { return decoder.counts(); }
  const LineCounts& causes() const { return decoder.counts().lines; }
};

// The packets of lines that follow a first one, which is always dropped.
Lines linesOfText(const std::string& text, const DecoderOptions& options = ::options()) {
  TextBench bench(options);
  bench.feed("\n" + text).decoder.finish();
  return bench.lines();
}

std::string scanLine(int sequence, std::uint32_t time, const std::string& counts) {
  return "scan #" + std::to_string(sequence) + " @" + std::to_string(time) + " 1x3 full 1023 took 0 counts " +
         counts;
}

const Lines kOneScan = {scanLine(1, 12000, "0 512 1023")};

TEST(TextDecoder, ReadsTimeAndCountsOfALine) {
  EXPECT_EQ(linesOfText("12,0,512,1023\n"), kOneScan);
  EXPECT_EQ(linesOfText("12,0,512,1023\r\n"), kOneScan);
  const Lines matrix = {"scan #1 @7 2x2 full 4095 took 0 counts 1 2 3 4095"};
  EXPECT_EQ(linesOfText("7,1,2,3,4095\n", {{2, 2}, 4095, 1, false}), matrix);
}

TEST(TextDecoder, ReadsEverySeparatorWithBlanksAroundItAndOneBehindTheLastNumber) {
  for (const std::string line :
       {"12;0;512;1023", "12\t0\t512\t1023", "12 0 512 1023", "12, 0, 512, 1023", "  12 ;\t0 ; 512 ; 1023 ",
        "12   0  512 1023 ", "12,0,512,1023,", "12,0,512,1023, ", "12\t0\t512\t1023\t",
        "12\t   0\t 512\t1023", "0012,000,0512,1023"}) {
    EXPECT_EQ(linesOfText(line + "\r\n"), kOneScan) << line;
  }
}

TEST(TextDecoder, RefusesALineWithTwoSeparatorsOrAnEmptyField) {
  for (const std::string line : {"12,0;512,1023", "12,0 512,1023", "12 0\t512\t1023", "12,,0,512,1023",
                                 ",12,0,512,1023", "12,0,512,1023,,"}) {
    TextBench bench;
    bench.feed("\n" + line + "\n");
    EXPECT_EQ(bench.lines(), Lines{}) << line;
    EXPECT_EQ(bench.causes().not_numbers, 1U) << line;
  }
}

TEST(TextDecoder, PassesOverHeadersCommentsAndEmptyLines) {
  TextBench bench;
  bench.feed(
      "\ntime,a,b,c\r\n\"time\";\"r0c0\"\n# 12,0,512,1023\n# 20 \xC2\xB5s\n\r\n\nReady.\n12,0,512,1023\n");
  EXPECT_EQ(bench.lines(), kOneScan);
  EXPECT_EQ(bench.causes().without_numbers, 7U);
  EXPECT_EQ(bench.counts().skipped_bytes, 1U) << "of the first line";
}

TEST(TextDecoder, ReadsTriggersFromCommentsAndPassesOverOtherComments) {
  const Lines edges = {"trigger #1 @12000 rising +- 1000", "trigger #2 @15000 falling +- 0"};
  EXPECT_EQ(linesOfText("#trigger,12,1,1\r\n#trigger, 15, 0, 0\n"), edges);
  for (const std::string line :
       {"#trigger", "#trigger,12,1", "#trigger,12,2,1", "#trigger,12,1,1,1", "#triggers,1,1,1",
        "#trigger,-1,1,1", "#trigger,12,1,99999999", "#trigger,a,1,1"}) {
    TextBench bench;
    bench.feed("\n" + line + "\n12,0,512,1023\n");
    EXPECT_EQ(bench.lines(), kOneScan) << line;
    EXPECT_EQ(bench.counts().skipped_bytes, 1U) << line;
  }
}

TEST(TextDecoder, DropsTheFirstLineOfAStreamBecauseItsStartMayBeMissing) {
  TextBench bench;
  bench.feed("2,0,512,1023\n12,0,512,1023\n");
  EXPECT_EQ(bench.lines(), kOneScan);
  EXPECT_EQ(bench.causes().cut, 1U);
  EXPECT_EQ(bench.counts().skipped_bytes, 13U);
  EXPECT_EQ(bench.counts().of(PacketType::kScan).lost, 0U);
}

TEST(TextDecoder, DropsTheLastLineOfAStreamBecauseItsEndMayBeMissing) {
  TextBench bench;
  bench.feed("\n12,0,512,102").decoder.finish();
  bench.feed("3\n13,1,2,3\n");
  EXPECT_EQ(bench.lines(), Lines{scanLine(1, 13000, "1 2 3")});
  EXPECT_EQ(bench.causes().cut, 3U) << "the first, the last, and the first of the next stream";
}

TEST(TextDecoder, CountsDamageByItsCauseAndReadsTheNextLine) {
  TextBench bench;
  bench.feed("\n1,2,3,4\n" + std::string(4000, '1') + "\n" + "2,0,5\xFF,1\n" + "3,0,0x12,1\n" + "4,0,-5,1\n" +
             "5.5,0,5,1\n" + "6,0,5\n" + "7,0,5,1,8\n" + "8,0,1024,2000\n" + "9,2,3,4\n");
  EXPECT_EQ(bench.lines(), (Lines{scanLine(1, 1000, "2 3 4"), scanLine(10, 9000, "2 3 4")}));
  EXPECT_EQ(bench.causes().cut, 1U);
  EXPECT_EQ(bench.causes().too_long, 1U);
  EXPECT_EQ(bench.causes().not_ascii, 1U);
  EXPECT_EQ(bench.causes().not_numbers, 3U);
  EXPECT_EQ(bench.causes().wrong_number, 2U);
  EXPECT_EQ(bench.causes().last_number, 4U);
  EXPECT_EQ(bench.causes().above_full_scale, 1U);
  EXPECT_EQ(bench.causes().highest_count, 2000U);
  EXPECT_EQ(bench.counts().bad_content, 3U) << "whole numbers, but not of this matrix";
  EXPECT_EQ(bench.counts().skipped_bytes, 1U + 4001U + 9U + 11U + 9U + 10U);
}

TEST(TextDecoder, SkipsBytesWithoutANewlineWhileTheyCome) {
  TextBench bench;
  bench.feed("\n" + std::string(200, '\x80'));
  EXPECT_EQ(bench.counts().skipped_bytes, 201U);
  EXPECT_EQ(bench.causes().not_ascii, 1U);
}

// So that a recording shows them, as it shows packets of the wire format that were lost.
TEST(TextDecoder, NumbersTheScansSoThatDamagedLinesLeaveAGap) {
  TextBench bench;
  bench.feed("\n1,0,0,0\n2,0,0\n3,x,0,0\n4,0,0,0\n5,0,0,0\n");
  EXPECT_EQ(bench.lines(),
            (Lines{scanLine(1, 1000, "0 0 0"), scanLine(4, 4000, "0 0 0"), scanLine(5, 5000, "0 0 0")}));
  EXPECT_EQ(bench.counts().of(PacketType::kScan).gaps, 1U);
  EXPECT_EQ(bench.counts().of(PacketType::kScan).lost, 2U);
  EXPECT_EQ(bench.counts().of(PacketType::kScan).packets, 3U);
}

TEST(TextDecoder, CountsNoGapAcrossTheEndOfAStream) {
  TextBench bench;
  bench.feed("\n1,0,0,0\nx\n").decoder.finish();
  bench.feed("0\n1,0,0,0\n");
  EXPECT_EQ(bench.lines().back(), scanLine(2, 1000, "0 0 0"));
  EXPECT_EQ(bench.counts().of(PacketType::kScan).gaps, 0U);
}

// 2^32 ms = 49.7 days; 4294967295 ms are 4294966296 us modulo 2^32.
TEST(TextDecoder, ContinuesTheDeviceTimeWhereMillisecondsOrMicrosecondsWrap) {
  EXPECT_EQ(linesOfText("4294967295,0,0,0\n0,0,0,0\n1,0,0,0\n"),
            (Lines{scanLine(1, 4294966296, "0 0 0"), scanLine(2, 0, "0 0 0"), scanLine(3, 1000, "0 0 0")}));
  EXPECT_EQ(linesOfText("4294967295,0,0,0\n0,0,0,0\n", options(false, 1)),
            (Lines{scanLine(1, 4294967295, "0 0 0"), scanLine(2, 0, "0 0 0")}));
  EXPECT_EQ(linesOfText("4294967297,0,0,0\n", options(false, 1)), Lines{scanLine(1, 1, "0 0 0")})
      << "a counter of 64 bits";
}

TEST(TextDecoder, ReadsTheTransducerBehindTheCounts) {
  const Lines expected = {scanLine(1, 12000, "1 2 3"), "transducer #1 @12000 -70000"};
  EXPECT_EQ(linesOfText("12,1,2,3,-70000\n", options(true)), expected);
  EXPECT_EQ(linesOfText("12,1,2,3\n12,1,2,3,2147483648\n", options(true)), Lines{});
}

// docs/text_format.md: without sign, except for a transducer's reading.
TEST(TextDecoder, RefusesASignBeforeAZeroUnlessTheTransducerReadsIt) {
  for (const std::string line : {"-0,0,512,1023", "12,-0,512,1023", "12,0,512,-0", "12,+0,512,1023"}) {
    TextBench bench;
    bench.feed("\n" + line + "\n");
    EXPECT_EQ(bench.lines(), Lines{}) << line;
    EXPECT_EQ(bench.causes().not_numbers, 1U) << line;
  }
  const Lines expected = {scanLine(1, 12000, "1 2 3"), "transducer #1 @12000 0"};
  EXPECT_EQ(linesOfText("12,1,2,3,-0\n", options(true)), expected);
}

TEST(TextDecoder, SaysThatItNeedsTheMatrix) {
  test_support::PacketRecorder recorder;
  EXPECT_EQ(test_support::refusal([&] {
              const fsr::protocol::TextDecoder decoder(recorder, {{7, 0}, 1023, 1000, false});
            }),
            "the protocol text needs the number of rows and of columns: a line of counts does not say them");
}

const std::string kStream = "time,a,b,c\r\n12,0,512,1023\r\n13,9,8,7\r\n14,100,200,300\r\n15,5,5,5\r\n";
const Lines kFour = {scanLine(1, 12000, "0 512 1023"), scanLine(2, 13000, "9 8 7"),
                     scanLine(3, 14000, "100 200 300"), scanLine(4, 15000, "5 5 5")};

TEST(TextDecoder, ReadsTheSameScansInChunksOfAnySize) {
  for (std::size_t chunk = 1; chunk <= kStream.size(); ++chunk) {
    TextBench bench;
    for (std::size_t at = 0; at < kStream.size(); at += chunk) bench.feed(kStream.substr(at, chunk));
    ASSERT_EQ(bench.lines(), kFour) << "chunks of " << chunk;
  }
}

// The content of the scans, without their numbers.
Lines contents(Lines lines) {
  for (std::string& line : lines) line = line.substr(line.find('@'));
  return lines;
}

// What lines without a checksum permit: damage to one line reaches the scan of that line and, where a newline
// is hit, of the next one, but no other.
TEST(TextDecoder, LosesTheNextLineAtMostWhereAByteIsLostChangedOrInserted) {
  const std::size_t begin = kStream.find("13"), end = kStream.find("14");
  for (std::size_t at = begin; at < end; ++at) {
    Lines damaged = {kStream.substr(0, at) + kStream.substr(at + 1)};
    for (int bit = 0; bit < 8; ++bit) {
      damaged.push_back(kStream);
      damaged.back()[at] = static_cast<char>(kStream[at] ^ (1 << bit));
    }
    for (const char inserted : {'\0', '\n', '\r', ',', '5', '#', '\xFF'}) {
      damaged.push_back(kStream.substr(0, at) + inserted + kStream.substr(at));
    }
    for (const std::string& stream : damaged) {
      TextBench bench;
      const Lines found = contents(bench.feed(stream).lines());
      ASSERT_GE(found.size(), 2U) << stream;
      EXPECT_EQ(found.front(), contents(kFour).front()) << stream;
      EXPECT_EQ(found.back(), contents(kFour).back()) << stream;
    }
  }
}

// docs/text_format.md says so.
TEST(TextDecoder, CannotTellAFlippedDigitNorTwoHalvesOfLines) {
  EXPECT_EQ(linesOfText("12,0,513,1023\n"), Lines{scanLine(1, 12000, "0 513 1023")}) << "printed as 512";
  EXPECT_EQ(linesOfText("12,0,8,7\n"), Lines{scanLine(1, 12000, "0 8 7")}) << "of 12,0,512,1023 and 13,9,8,7";
}

TEST(TextDecoder, SurvivesAnyBytesInChunksOfAnySize) {
  const std::string likely = "0123456789,,,;\t \r\n\n#-ax";
  for (unsigned seed = 1; seed <= 300; ++seed) {
    std::mt19937 random(seed);
    std::string text;
    for (int i = 0; i < 3000; ++i) {
      text += random() % 50 == 0 ? static_cast<char>(random() % 256) : likely[random() % likely.size()];
    }
    TextBench whole, parts;
    whole.feed(text).decoder.finish();
    for (std::size_t at = 0; at < text.size();) {
      const std::size_t size = 1 + random() % 40;
      parts.feed(text.substr(at, size));
      at += size;
    }
    parts.decoder.finish();
    ASSERT_EQ(whole.lines(), parts.lines()) << "seed " << seed;
    ASSERT_EQ(whole.counts().skipped_bytes, parts.counts().skipped_bytes) << "seed " << seed;
    ASSERT_LE(whole.counts().skipped_bytes, text.size());
    ASSERT_EQ(whole.counts().of(PacketType::kScan).packets, whole.lines().size());
  }
}

}  // namespace
