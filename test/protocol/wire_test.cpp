#include "fsr_pressure_map/protocol/wire.h"

#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

#include "support/program_output.h"
#include "support/pty.h"
#include "support/source_dir.h"

namespace {

using Bytes = std::vector<std::uint8_t>;
using Buffer = std::array<std::uint8_t, FSR_WIRE_MAX_PACKET>;

// The literal packets below were computed with Python 3.11.2 (struct, binascii, zlib):
//
//   def packet(kind, seq, t, payload):
//       head = struct.pack('<BBHII', 1, kind, len(payload), seq, t)
//       head += struct.pack('<H', binascii.crc_hqx(head, 0xFFFF))
//       return b'\xa5\x5a' + head + payload + struct.pack('<I', zlib.crc32(head + payload))

constexpr std::array<std::uint16_t, 6> kCounts = {0, 1, 258, 2730, 4094, 4095};
constexpr fsr_wire_scan kScan = {2, 3, 4095, 5000, kCounts.data()};

// packet(1, 7, 123456789, struct.pack('<BBHI6H', 2, 3, 4095, 5000, 0, 1, 258, 2730, 4094, 4095))
const Bytes kScanPacket = {0xA5, 0x5A, 0x01, 0x01, 0x14, 0x00, 0x07, 0x00, 0x00, 0x00, 0x15, 0xCD, 0x5B, 0x07,
                           0x98, 0xC0, 0x02, 0x03, 0xFF, 0x0F, 0x88, 0x13, 0x00, 0x00, 0x00, 0x00, 0x01, 0x00,
                           0x02, 0x01, 0xAA, 0x0A, 0xFE, 0x0F, 0xFF, 0x0F, 0x09, 0x94, 0x49, 0x66};

TEST(Wire, ChecksMatchTheCataloguesOfCyclicCodes) {
  const std::string digits = "123456789";
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(digits.data());
  EXPECT_EQ(fsr_wire_crc16(bytes, digits.size()), 0x29B1);
  EXPECT_EQ(fsr_wire_crc32(bytes, digits.size()), 0xCBF43926);
}

TEST(Wire, EncodesAScanByteForByte) {
  Buffer buffer{};
  const std::size_t size = fsr_wire_encode_scan(buffer.data(), buffer.size(), 7, 123456789, &kScan);
  EXPECT_EQ(Bytes(buffer.begin(), buffer.begin() + size), kScanPacket);
}

TEST(Wire, EncodesATransducerReadingByteForByte) {
  Buffer buffer{};
  // packet(2, 0xFFFFFFFF, 0xFFFFFFFE, struct.pack('<i', -2))
  const Bytes expected = {0xA5, 0x5A, 0x01, 0x02, 0x04, 0x00, 0xFF, 0xFF, 0xFF, 0xFF, 0xFE, 0xFF,
                          0xFF, 0xFF, 0x5F, 0x5A, 0xFE, 0xFF, 0xFF, 0xFF, 0xAD, 0xF5, 0xCB, 0xBC};
  const std::size_t size =
      fsr_wire_encode_transducer(buffer.data(), buffer.size(), 0xFFFFFFFF, 0xFFFFFFFE, -2);
  EXPECT_EQ(Bytes(buffer.begin(), buffer.begin() + size), expected);
}

TEST(Wire, EncodesATemperatureByteForByte) {
  Buffer buffer{};
  // packet(3, 1, 1000000, struct.pack('<i', 23750))
  const Bytes expected = {0xA5, 0x5A, 0x01, 0x03, 0x04, 0x00, 0x01, 0x00, 0x00, 0x00, 0x40, 0x42,
                          0x0F, 0x00, 0xFF, 0x18, 0xC6, 0x5C, 0x00, 0x00, 0xD5, 0xA0, 0xC7, 0xA7};
  const std::size_t size = fsr_wire_encode_temperature(buffer.data(), buffer.size(), 1, 1000000, 23750);
  EXPECT_EQ(Bytes(buffer.begin(), buffer.begin() + size), expected);
}

TEST(Wire, EncodesAnIdentityByteForByteAndCutsLongTexts) {
  Buffer buffer{};
  // packet(4, 2, 2000000, struct.pack('<16s16s16sBBHI', b'FSR-0042', b'1.2.0', b'0123456789abcdef',
  //                                   7, 10, 4095, 10000))
  const Bytes expected = {0xA5, 0x5A, 0x01, 0x04, 0x38, 0x00, 0x02, 0x00, 0x00, 0x00, 0x80, 0x84, 0x1E,
                          0x00, 0x63, 0xA4, 0x46, 0x53, 0x52, 0x2D, 0x30, 0x30, 0x34, 0x32, 0x00, 0x00,
                          0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x31, 0x2E, 0x32, 0x2E, 0x30, 0x00, 0x00,
                          0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x30, 0x31, 0x32, 0x33,
                          0x34, 0x35, 0x36, 0x37, 0x38, 0x39, 0x61, 0x62, 0x63, 0x64, 0x65, 0x66, 0x07,
                          0x0A, 0xFF, 0x0F, 0x10, 0x27, 0x00, 0x00, 0x95, 0x30, 0x87, 0xE2};
  const fsr_wire_identity identity = {"FSR-0042", "1.2.0", "0123456789abcdef and more", 7, 10, 4095, 10000};
  const std::size_t size = fsr_wire_encode_identity(buffer.data(), buffer.size(), 2, 2000000, &identity);
  EXPECT_EQ(Bytes(buffer.begin(), buffer.begin() + size), expected);
}

TEST(Wire, EncodesATriggerByteForByte) {
  Buffer buffer{};
  // packet(5, 3, 4000000000, struct.pack('<BI', 1, 70000))
  const Bytes expected = {0xA5, 0x5A, 0x01, 0x05, 0x05, 0x00, 0x03, 0x00, 0x00, 0x00, 0x00, 0x28, 0x6B,
                          0xEE, 0xD0, 0xE0, 0x01, 0x70, 0x11, 0x01, 0x00, 0xC6, 0xAC, 0x02, 0xF7};
  EXPECT_EQ(fsr_wire_encode_trigger(buffer.data(), 24, 3, 4000000000, 1, 70000), 0U);
  const std::size_t size = fsr_wire_encode_trigger(buffer.data(), buffer.size(), 3, 4000000000, 1, 70000);
  EXPECT_EQ(Bytes(buffer.begin(), buffer.begin() + size), expected);
}

TEST(Wire, RefusesABufferThatIsTooSmallWithoutWritingToIt) {
  const fsr_wire_identity identity = {"", "", "", 7, 10, 4095, 0};
  Buffer buffer{};
  for (std::size_t room = 0; room < kScanPacket.size(); ++room) {
    EXPECT_EQ(fsr_wire_encode_scan(buffer.data(), room, 7, 1, &kScan), 0U) << room;
  }
  EXPECT_EQ(fsr_wire_encode_transducer(buffer.data(), 23, 1, 1, 1), 0U);
  EXPECT_EQ(fsr_wire_encode_temperature(buffer.data(), 23, 1, 1, 1), 0U);
  EXPECT_EQ(fsr_wire_encode_identity(buffer.data(), 75, 1, 1, &identity), 0U);
  EXPECT_EQ(buffer, Buffer{});
}

TEST(Wire, EncodesEverySizeUpToSixtyFourSquareAndNoOther) {
  const std::vector<std::uint16_t> counts(64 * 64, 1);
  Buffer buffer{};
  const auto length = [&](int rows, int columns, std::uint16_t full_scale) {
    const fsr_wire_scan scan = {static_cast<std::uint8_t>(rows), static_cast<std::uint8_t>(columns),
                                full_scale, 0, counts.data()};
    return fsr_wire_encode_scan(buffer.data(), buffer.size(), 0, 0, &scan);
  };
  for (int rows = 1; rows <= 64; ++rows) {
    for (int columns = 1; columns <= 64; ++columns) {
      ASSERT_EQ(length(rows, columns, 4095), std::size_t(28 + 2 * rows * columns));
    }
  }
  EXPECT_EQ(length(0, 10, 4095), 0U);
  EXPECT_EQ(length(10, 0, 4095), 0U);
  EXPECT_EQ(length(65, 10, 4095), 0U);
  EXPECT_EQ(length(10, 65, 4095), 0U);
  EXPECT_EQ(length(7, 10, 0), 0U);
}

// As docs/boards.md says: both files in one folder of the firmware project.
TEST(Wire, CompilesFreestandingAndNeedsNoLibrary) {
  const test_support::TemporaryFolder firmware;
  const std::string source = test_support::sourceDir();
  const test_support::ProgramOutput compiled = test_support::outputOf(
      "cp " + source + "/include/fsr_pressure_map/protocol/wire.h " + source + "/src/protocol/wire.c " +
      firmware.path() + " && cd " + firmware.path() +
      " && gcc -std=c99 -ffreestanding -nostdlib -Os -c -Wall -Wextra -Wpedantic -Werror wire.c 2>&1");
  EXPECT_EQ(compiled.status, 0) << compiled.text;
  // The compiler itself may call memcpy and memset, freestanding or not; firmware always has those.
  const test_support::ProgramOutput undefined = test_support::outputOf(
      "nm --undefined-only " + firmware.path("wire.o") + " | grep -v -w -e memcpy -e memset");
  EXPECT_EQ(undefined.text, "");
}

}  // namespace
