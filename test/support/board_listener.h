#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "protocol/serial_port.h"
#include "protocol/wire_decoder.h"

namespace test_support {

/// Opens a board's port as the driver does and keeps the decoded packets.
class BoardListener : public fsr::protocol::PacketHandler {
 public:
  struct Scan {
    std::uint32_t sequence;
    std::uint32_t device_time;  // [us]
    std::vector<std::uint16_t> counts;
  };
  struct Reading {
    std::uint32_t device_time;  // [us]
    std::int32_t value;
  };

  explicit BoardListener(const std::string& port, std::uint32_t baud = 0)
      : port_(port, baud, [] { return std::int64_t{0}; }), decoder_(*this) {}

  std::vector<Scan> scans;
  std::vector<Reading> transducer;
  std::vector<Reading> temperature;
  std::vector<bool> triggers;        // levels behind the edges
  std::vector<std::string> serials;  // one for each identity packet

  /// Reads until the condition is true. Returns false after 30 s.
  bool until(const std::function<bool()>& condition) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
    while (!condition() && std::chrono::steady_clock::now() < end) read();
    return condition();
  }
  bool untilScans(std::size_t more) {
    const std::size_t target = scans.size() + more;
    return until([this, target] { return scans.size() >= target; });
  }
  const fsr::protocol::DecoderCounts& counts() const { return decoder_.counts(); }

  void onScan(const fsr::protocol::PacketHeader& header, const fsr::protocol::ScanPacket& scan) override {
    scans.push_back({header.sequence, header.device_time, {scan.counts, scan.counts + scan.size.taxels()}});
  }
  void onTransducer(const fsr::protocol::PacketHeader& header, std::int32_t counts) override {
    transducer.push_back({header.device_time, counts});
  }
  void onTemperature(const fsr::protocol::PacketHeader& header, std::int32_t millidegrees) override {
    temperature.push_back({header.device_time, millidegrees});
  }
  void onIdentity(const fsr::protocol::PacketHeader&,
                  const fsr::protocol::IdentityPacket& identity) override {
    serials.emplace_back(identity.serial);
  }
  void onTrigger(const fsr::protocol::PacketHeader&, const fsr::protocol::TriggerPacket& trigger) override {
    triggers.push_back(trigger.high);
  }

 private:
  void read() {
    std::uint8_t bytes[4096];
    const fsr::protocol::Chunk chunk = port_.read(bytes, sizeof(bytes), std::chrono::milliseconds(100));
    decoder_.feed(bytes, chunk.size);
  }

  fsr::protocol::SerialPort port_;
  fsr::protocol::WireDecoder decoder_;
};

}  // namespace test_support
