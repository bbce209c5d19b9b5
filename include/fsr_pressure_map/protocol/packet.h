#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "fsr_pressure_map/matrix/layout.h"

namespace fsr::protocol {

/// What a packet tells.
enum class PacketType : unsigned { kScan, kTransducer, kTemperature, kIdentity };
constexpr std::size_t kPacketTypes = 4;

/// What every packet carries.
struct PacketHeader {
  std::uint32_t sequence = 0;     ///< counts the packets of one type, wraps
  std::uint32_t device_time = 0;  ///< the board's clock [us], wraps after 71.6 minutes
  std::size_t size = 0;           ///< of the whole packet [bytes]
};

/// One scan. The counts are in the decoder's memory and valid during the call only.
struct ScanPacket {
  matrix::MatrixSize size;
  std::uint16_t full_scale = 0;           ///< largest count that the converter can give
  std::uint32_t duration = 0;             ///< from the first to the last taxel [us]; 0 = unknown
  const std::uint16_t* counts = nullptr;  ///< [rows x columns], row-major, none above full_scale
};

/// Who the board is. The texts are in the decoder's memory and valid during the call only. They are as the
/// board sent them: a caller that prints them must expect any byte but zero.
struct IdentityPacket {
  std::string_view serial;
  std::string_view firmware;
  std::string_view model;
  matrix::MatrixSize size;
  std::uint16_t full_scale = 0;
  std::uint32_t scan_period = 0;  ///< [us]; 0 = unknown
};

/// Receives the packets that a decoder finds.
class PacketHandler {
 public:
  virtual ~PacketHandler() = default;

  virtual void onScan(const PacketHeader& header, const ScanPacket& scan) = 0;
  /// `counts`: raw reading of the pressure transducer.
  virtual void onTransducer(const PacketHeader& header, std::int32_t counts) = 0;
  /// `millidegrees`: [0.001 degree Celsius].
  virtual void onTemperature(const PacketHeader& header, std::int32_t millidegrees) = 0;
  virtual void onIdentity(const PacketHeader& header, const IdentityPacket& identity) = 0;
};

}  // namespace fsr::protocol
