#pragma once

#include <array>
#include <cstdint>

#include "fsr_pressure_map/protocol/packet.h"
#include "fsr_pressure_map/protocol/wire.h"
#include "protocol/device_clock.h"

namespace fsr::protocol {

/// When a packet's content was true.
struct PacketTime {
  std::int64_t stamp = 0;         ///< host time [ns], strictly increasing for each type of packet
  std::uint64_t device_time = 0;  ///< the board's clock at the stamp [us]
};

/// Stamps packets: knows the line's speed and the arrival of the bytes at hand, keeps the board's clock.
class PacketStamper {
 public:
  explicit PacketStamper(const DeviceClockOptions& options = {}) : clock_(options) {}

  /// A new connection over a line of `baud` [1/s]; 0 = bytes take no time.
  void startLine(std::uint32_t baud);
  /// The packets that follow were complete at `receive_time` [host, ns].
  void setArrival(std::int64_t receive_time) { receive_time_ = receive_time; }

  /// `duration` of the scan [us]. A board sends a scan after its last taxel at the earliest, so half of it
  /// lies between the middle of the scan and the arrival, beside the bytes' own time on the line.
  PacketTime scan(const PacketHeader& header, std::uint32_t duration);
  PacketTime transducer(const PacketHeader& header);
  /// Teaches the clock nothing: a temperature may be sent long after it was taken.
  PacketTime temperature(const PacketHeader& header);

  const DeviceClock& clock() const { return clock_; }

 private:
  std::int64_t timeOnTheLine(std::size_t bytes) const;
  PacketTime finish(unsigned type, std::uint64_t device_time);

  DeviceClock clock_;
  std::array<StampSequence, 3> sequences_;  // by type, from FSR_WIRE_SCAN on
  std::uint32_t baud_ = 0;
  std::int64_t receive_time_ = 0;
};

}  // namespace fsr::protocol
