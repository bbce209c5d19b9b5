#pragma once

#include <cstdint>

#include "fsr_pressure_map/matrix/layout.h"

namespace fsr::protocol {

/// Bytes per second of a serial line with 8N1, ten bits a byte [1/s].
double serialBytesPerSecond(std::uint32_t baud);

/// Bytes per second assumed for full-speed USB (12 Mbit/s) [1/s]. A bulk transfer has 64 bytes, and at most
/// 19 of them fit a frame of 1 ms. 10 are assumed, which leaves room for other devices.
constexpr double kUsbFullSpeedBytesPerSecond = 10 * 64 * 1000.0;

/// Scans per second that a link of `bytes_per_second` can carry [1/s], each with one transducer reading,
/// besides one temperature and one identity per second. 0 where not even those fit.
double scanRate(double bytes_per_second, matrix::MatrixSize size);

}  // namespace fsr::protocol
