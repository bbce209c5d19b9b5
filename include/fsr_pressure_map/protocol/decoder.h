#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "fsr_pressure_map/protocol/packet.h"
#include "fsr_pressure_map/protocol/wire.h"

namespace fsr::protocol {

/// How the packets of one type followed each other.
struct SequenceCounts {
  std::uint64_t packets = 0;     ///< delivered to the handler
  std::uint64_t gaps = 0;        ///< places where the board's counter jumped forward
  std::uint64_t lost = 0;        ///< packets that those jumps skipped
  std::uint64_t duplicates = 0;  ///< same number and device time as the one before: not delivered
  std::uint64_t restarts = 0;    ///< the counter went backwards: the board started again
};

/// What the decoder met since it was made. Each cause counts the places where it occurred.
struct DecoderCounts {
  std::uint64_t bytes = 0;             ///< all that were fed
  std::uint64_t skipped_bytes = 0;     ///< of no good packet
  std::uint64_t bad_header_check = 0;  ///< sync word without a sound header behind it
  std::uint64_t unknown_version = 0;   ///< sound header of another version of the format
  std::uint64_t unknown_type = 0;      ///< sound header of an unknown type
  std::uint64_t bad_length = 0;        ///< sound header whose length its type cannot have
  std::uint64_t bad_packet_check = 0;  ///< sound header, but the packet's CRC-32 is wrong
  std::uint64_t bad_content = 0;  ///< sound packet that says what cannot be (0 rows, count above full scale)
  std::array<SequenceCounts, 4> sequences;  ///< by type, from FSR_WIRE_SCAN on

  const SequenceCounts& of(unsigned type) const { return sequences.at(type - FSR_WIRE_SCAN); }
};

/// Finds the packets of the wire format in a stream of bytes that may start anywhere, come in any
/// chunks and be damaged anyhow. Never throws, allocates nothing.
///
/// A length is believed only where the header's own check confirms it and the type can have it. Where
/// any check fails, the search goes on one byte behind the sync word, INSIDE the damaged packet, so
/// that damage costs the packets that it hit and no other.
class Decoder {
 public:
  /// `handler` must outlive the decoder.
  explicit Decoder(PacketHandler& handler) : handler_(handler) {}

  /// Delivers every packet that these bytes complete, in order, before it returns.
  void feed(const std::uint8_t* bytes, std::size_t size);

  /// The stream ended: delivers what a packet that never came to its end may hide, drops the rest, and
  /// takes what is fed next as a new stream (no gap is counted across).
  void finish();

  const DecoderCounts& counts() const { return counts_; }

 private:
  struct Last {
    bool known = false;
    std::uint32_t sequence = 0;
    std::uint32_t device_time = 0;
  };

  bool step();
  void skip(std::size_t size);
  void skipToSync();
  void compact();
  std::size_t available() const { return end_ - begin_; }
  const std::uint8_t* front() const { return buffer_.data() + begin_; }
  bool headerIsSound();
  void deliver(std::size_t payload_size);
  bool isNew(unsigned type, const PacketHeader& header);
  bool deliverContent(unsigned type, const PacketHeader& header, const std::uint8_t* payload,
                      std::size_t size);
  bool deliverScan(const PacketHeader& header, const std::uint8_t* payload, std::size_t size);
  bool deliverIdentity(const PacketHeader& header, const std::uint8_t* payload);

  PacketHandler& handler_;
  DecoderCounts counts_;
  std::array<Last, 4> last_;
  // Twice the largest packet: what waits for its end is never longer than one, so there is always room.
  std::array<std::uint8_t, 2 * FSR_WIRE_MAX_PACKET> buffer_{};
  std::size_t begin_ = 0;
  std::size_t end_ = 0;
  std::array<std::uint16_t, FSR_WIRE_MAX_SIDE * FSR_WIRE_MAX_SIDE> scan_counts_{};
};

}  // namespace fsr::protocol
