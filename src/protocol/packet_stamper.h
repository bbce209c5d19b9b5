#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "fsr_pressure_map/protocol/decoder.h"
#include "protocol/device_clock.h"

namespace fsr::protocol {

/// Time of a packet's content.
struct PacketTime {
  std::int64_t stamp = 0;         ///< host time [ns], strictly increasing for each type of packet
  std::uint64_t device_time = 0;  ///< the board's clock at the stamp [us]
};

/// Computes the stamps of packets from the line's speed, the arrival of the bytes and the board's clock.
class PacketStamper {
 public:
  explicit PacketStamper(const DeviceClockOptions& options = {}) : clock_(options) {}

  /// Starts a new connection over a line of `baud` [1/s]; 0 = the time of the bytes is negligible.
  void startLine(std::uint32_t baud);
  /// Sets the arrival of the packets that follow, `receive_time` [host, ns].
  void setArrival(std::int64_t receive_time) { receive_time_ = receive_time; }

  /// `duration` of the scan [us]. A board sends a scan after its last taxel at the earliest. So half of the
  /// duration lies between the middle of the scan and its arrival, in addition to the time on the line. Scans
  /// do not overlap: a duration longer than the time from scan to scan is replaced by the last good one. That
  /// of the first scan is judged with the second one; if it cannot be, the estimate of the clock restarts.
  PacketTime scan(const PacketHeader& header, std::uint32_t duration);
  PacketTime transducer(const PacketHeader& header) { return soon(PacketType::kTransducer, header); }
  PacketTime trigger(const PacketHeader& header) { return soon(PacketType::kTrigger, header); }
  /// Does not update the clock, because a temperature may be sent long after it was measured.
  PacketTime temperature(const PacketHeader& header);

  const DeviceClock& clock() const { return clock_; }
  /// Scans whose duration was longer than the time from scan to scan, and so was not used.
  std::uint64_t impossibleDurations() const { return impossible_durations_; }

 private:
  std::int64_t timeOnTheLine(std::size_t bytes) const;
  std::optional<double> periodBefore(const PacketHeader& header) const;
  bool isPossible(std::uint32_t duration, std::optional<double> period) const;
  std::uint32_t possibleDuration(const PacketHeader& header, std::uint32_t duration);
  PacketTime soon(PacketType type, const PacketHeader& header);
  PacketTime finish(PacketType type, std::uint64_t device_time);

  DeviceClock clock_;
  std::array<StampSequence, kPacketTypes> sequences_;  // by PacketType
  std::uint32_t baud_ = 0;
  std::int64_t receive_time_ = 0;
  bool scanned_ = false;  // a scan has come over this line
  PacketHeader last_scan_;
  std::uint32_t last_duration_ = 0;  // [us]
  std::optional<double> period_;     // between the last two scans between which it was known [us]
  std::uint64_t impossible_durations_ = 0;
};

}  // namespace fsr::protocol
