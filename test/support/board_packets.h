#pragma once

#include <cstdint>
#include <vector>

#include "fsr_pressure_map/protocol/wire.h"

/// Packets of a small board, for tests that imitate one.
namespace test_support {

using Bytes = std::vector<std::uint8_t>;

inline Bytes scanPacket(std::uint32_t sequence, std::uint32_t time_us, std::uint8_t rows,
                        std::uint8_t columns, const std::vector<std::uint16_t>& counts,
                        std::uint32_t duration_us = 5000) {
  const fsr_wire_scan scan = {rows, columns, 4095, duration_us, counts.data()};
  Bytes packet(FSR_WIRE_MAX_PACKET);
  packet.resize(fsr_wire_encode_scan(packet.data(), packet.size(), sequence, time_us, &scan));
  return packet;
}

inline Bytes transducerPacket(std::uint32_t sequence, std::uint32_t time_us, std::int32_t counts) {
  Bytes packet(FSR_WIRE_MAX_PACKET);
  packet.resize(fsr_wire_encode_transducer(packet.data(), packet.size(), sequence, time_us, counts));
  return packet;
}

inline Bytes temperaturePacket(std::uint32_t sequence, std::uint32_t time_us, std::int32_t millidegrees) {
  Bytes packet(FSR_WIRE_MAX_PACKET);
  packet.resize(fsr_wire_encode_temperature(packet.data(), packet.size(), sequence, time_us, millidegrees));
  return packet;
}

inline Bytes triggerPacket(std::uint32_t sequence, std::uint32_t time_us, bool high,
                           std::uint32_t deviation_us) {
  Bytes packet(FSR_WIRE_MAX_PACKET);
  packet.resize(
      fsr_wire_encode_trigger(packet.data(), packet.size(), sequence, time_us, high ? 1 : 0, deviation_us));
  return packet;
}

inline Bytes identityPacket(std::uint32_t sequence, std::uint32_t time_us, std::uint8_t rows,
                            std::uint8_t columns, const char* serial) {
  const fsr_wire_identity identity = {serial, "1.2.0", "test board", rows, columns, 4095, 10000};
  Bytes packet(FSR_WIRE_MAX_PACKET);
  packet.resize(fsr_wire_encode_identity(packet.data(), packet.size(), sequence, time_us, &identity));
  return packet;
}

}  // namespace test_support
