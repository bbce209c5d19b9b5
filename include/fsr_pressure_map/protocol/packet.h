#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "fsr_pressure_map/matrix/layout.h"

namespace fsr::protocol {

/// What every packet of the wire format carries.
struct PacketHeader {
  std::uint32_t sequence = 0;     ///< counts the packets of one type, wraps
  std::uint32_t device_time = 0;  ///< the board's clock [us], wraps after 71.6 minutes
  std::size_t size = 0;           ///< of the whole packet [bytes]
};

/// One scan. The counts are the decoder's own memory, valid during the call only.
struct ScanPacket {
  matrix::MatrixSize size;
  std::uint16_t full_scale = 0;           ///< largest count that the converter can give
  std::uint32_t duration = 0;             ///< first to last taxel [us]; 0 = unknown
  const std::uint16_t* counts = nullptr;  ///< [rows x columns], row-major, none above full_scale
};

/// Who the board is. The texts are the decoder's own memory, valid during the call only; they are as
/// the board sent them, so a caller that prints them should expect any byte but zero.
struct IdentityPacket {
  std::string_view serial;
  std::string_view firmware;
  std::string_view model;
  matrix::MatrixSize size;
  std::uint16_t full_scale = 0;
  std::uint32_t scan_period = 0;  ///< [us]; 0 = unknown
};

/// Where the decoder puts what it found.
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
