#include "protocol/link_rate.h"

#include <algorithm>

#include "fsr_pressure_map/protocol/wire.h"

namespace fsr::protocol {

double serialBytesPerSecond(std::uint32_t baud) {
  return baud / 10.0;
}

double scanRate(double bytes_per_second, matrix::MatrixSize size) {
  constexpr double kEachSecond =
      2 * FSR_WIRE_OVERHEAD + FSR_WIRE_TEMPERATURE_PAYLOAD + FSR_WIRE_IDENTITY_PAYLOAD;  // [bytes]
  const double each_scan = 2 * FSR_WIRE_OVERHEAD + FSR_WIRE_TRANSDUCER_PAYLOAD +
                           static_cast<double>(FSR_WIRE_SCAN_PAYLOAD(0U, 0U) + 2 * size.taxels());  // [bytes]
  return std::max(0.0, bytes_per_second - kEachSecond) / each_scan;
}

}  // namespace fsr::protocol
