#pragma once

#include <algorithm>
#include <cstdint>

#include "fsr_pressure_map/matrix/layout.h"
#include "fsr_pressure_map/protocol/wire.h"

namespace test_support {

/// Bytes per second of a serial line with 8N1, ten bits a byte [1/s].
inline double serialBytesPerSecond(std::uint32_t baud) {
  return baud / 10.0;
}

/// Bytes per second assumed for full-speed USB (12 Mbit/s) [1/s]. A bulk transfer has 64 bytes, and at most
/// 19 of them fit a frame of 1 ms. 10 are assumed, which leaves room for other devices.
constexpr double kUsbFullSpeedBytesPerSecond = 10 * 64 * 1000.0;

/// Scans per second that a link of `bytes_per_second` can carry [1/s], each with one transducer reading,
/// besides one temperature and one identity per second. 0 where not even those fit.
inline double scanRate(double bytes_per_second, fsr::matrix::MatrixSize size) {
  constexpr double kEachSecond =
      2 * FSR_WIRE_OVERHEAD + FSR_WIRE_TEMPERATURE_PAYLOAD + FSR_WIRE_IDENTITY_PAYLOAD;  // [bytes]
  const double each_scan = 2 * FSR_WIRE_OVERHEAD + FSR_WIRE_TRANSDUCER_PAYLOAD +
                           static_cast<double>(FSR_WIRE_SCAN_PAYLOAD(0U, 0U) + 2 * size.taxels());  // [bytes]
  return std::max(0.0, bytes_per_second - kEachSecond) / each_scan;
}

}  // namespace test_support
