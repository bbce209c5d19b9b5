#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "fsr_pressure_map/protocol/decoder.h"
#include "fsr_pressure_map/protocol/wire.h"

namespace fsr::protocol {

/// Decoder of the wire format (docs/wire_format.md).
///
/// A length is believed only where the header's own check confirms it and the packet's type can have it.
/// Where any check fails, the search continues one byte behind the sync word, INSIDE the damaged packet, so
/// that damage costs the packets that it hits and no other.
class WireDecoder final : public Decoder {
 public:
  /// `handler` must outlive the decoder.
  explicit WireDecoder(PacketHandler& handler) : handler_(handler) {}

  void feed(const std::uint8_t* bytes, std::size_t size) override;
  void finish() override;
  const DecoderCounts& counts() const override { return counts_; }

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
  bool isNew(PacketType type, const PacketHeader& header);
  bool deliverContent(PacketType type, const PacketHeader& header, const std::uint8_t* payload,
                      std::size_t size);
  bool deliverScan(const PacketHeader& header, const std::uint8_t* payload, std::size_t size);
  bool deliverIdentity(const PacketHeader& header, const std::uint8_t* payload);

  PacketHandler& handler_;
  DecoderCounts counts_;
  std::array<Last, kPacketTypes> last_;
  // Twice the largest packet: an incomplete packet is never longer than one, so there is always room.
  std::array<std::uint8_t, 2 * FSR_WIRE_MAX_PACKET> buffer_{};
  std::size_t begin_ = 0;
  std::size_t end_ = 0;
  std::array<std::uint16_t, FSR_WIRE_MAX_SIDE * FSR_WIRE_MAX_SIDE> scan_counts_{};
};

}  // namespace fsr::protocol
