#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

#include "protocol/device_clock.h"
#include "protocol/text_decoder.h"
#include "protocol/wire_decoder.h"
#include "support/allocation_guard.h"

namespace {

// Processes a packet like the driver, without ROS messages.
class StampingHandler : public fsr::protocol::PacketHandler {
 public:
  std::int64_t sum = 0;
  int scans = 0;

  void onScan(const fsr::protocol::PacketHeader& header, const fsr::protocol::ScanPacket& scan) override {
    const std::uint64_t time = clock_.observe(header.device_time, now_ += 1'000'000, scan.duration / 2);
    sum += stamps_.next(clock_.hostTime(time), time) + scan.counts[0];
    ++scans;
  }
  void onTransducer(const fsr::protocol::PacketHeader&, std::int32_t counts) override { sum += counts; }
  void onTemperature(const fsr::protocol::PacketHeader&, std::int32_t millidegrees) override {
    sum += millidegrees;
  }
  void onIdentity(const fsr::protocol::PacketHeader&,
                  const fsr::protocol::IdentityPacket& identity) override {
    sum += static_cast<std::int64_t>(identity.serial.size());
  }

 private:
  fsr::protocol::DeviceClock clock_;
  fsr::protocol::StampSequence stamps_;
  std::int64_t now_ = 0;
};

TEST(Protocol, AllocatesNothingFromBytesToStampedScans) {
  std::vector<std::uint16_t> counts(160, 4000);
  const fsr_wire_scan scan = {16, 10, 4095, 900, counts.data()};
  const fsr_wire_identity identity = {"0123456789abcdef", "0123456789abcdef", "", 16, 10, 4095, 1000};
  std::vector<std::uint8_t> bytes(1024);
  StampingHandler handler;
  fsr::protocol::WireDecoder decoder(handler);

  const test_support::AllocationGuard guard;
  for (std::uint32_t i = 0; i < 300'000; ++i) {  // five minutes at 1 kHz: the clock's window fills and moves
    std::size_t size = fsr_wire_encode_scan(bytes.data(), bytes.size(), i, i * 1000, &scan);
    size += fsr_wire_encode_identity(bytes.data() + size, bytes.size() - size, i, i * 1000, &identity);
    if (i % 7 == 0) bytes[i % size] ^= 0x20U;
    decoder.feed(bytes.data(), size);
  }
  EXPECT_EQ(guard.allocations(), 0U);
  EXPECT_GT(handler.scans, 125'000);
}

TEST(Protocol, AllocatesNothingFromLinesOfTextToStampedScans) {
  std::string line = "1000";
  for (int i = 0; i < 160; ++i) line += ",512";
  line += "\r\n";
  StampingHandler handler;
  fsr::protocol::TextDecoder decoder(handler, {{16, 10}, 1023, 1, false});

  const test_support::AllocationGuard guard;
  for (std::uint32_t i = 0; i < 20'000; ++i) {
    const std::size_t hit = i % line.size();
    if (i % 7 == 0) line[hit] = static_cast<char>(line[hit] ^ 0x40);
    decoder.feed(reinterpret_cast<const std::uint8_t*>(line.data()), line.size());
    if (i % 7 == 0) line[hit] = static_cast<char>(line[hit] ^ 0x40);
  }
  EXPECT_EQ(guard.allocations(), 0U);
  EXPECT_GT(handler.scans, 17'000);
  EXPECT_GT(decoder.counts().lines.not_numbers, 0U);
}

}  // namespace
