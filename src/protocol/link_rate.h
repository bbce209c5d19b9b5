#pragma once

#include <cstdint>

#include "fsr_pressure_map/matrix/layout.h"

namespace fsr::protocol {

/// Bytes that a serial line carries at 8N1: ten bits a byte [1/s].
double serialBytesPerSecond(std::uint32_t baud);

/// Bytes that full-speed USB (12 Mbit/s) is counted on for: bulk transfers move 64 bytes each and at most
/// 19 of them fit a frame of 1 ms; 10 are assumed, so that other devices have room [1/s].
constexpr double kUsbFullSpeedBytesPerSecond = 10 * 64 * 1000.0;

/// Scans a second that a link of `bytes_per_second` carries [1/s], each with one transducer reading, beside
/// one temperature and one identity a second; 0 where not even those fit.
double scanRate(double bytes_per_second, matrix::MatrixSize size);

}  // namespace fsr::protocol
