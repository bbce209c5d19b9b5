#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "fsr_pressure_map/matrix/layout.h"

namespace fsr::matrix {

/// One reading of every taxel, in counts of the converter.
struct Scan {
  MatrixSize size;
  std::uint16_t full_scale = 0;       ///< largest count that the converter can give, e.g. 4095
  std::vector<std::uint16_t> counts;  ///< [rows x columns], row-major
};

/// A scan whose counts are stored elsewhere, e.g. in a message.
struct ScanView {
  MatrixSize size;
  std::uint16_t full_scale = 0;
  const std::uint16_t* counts = nullptr;  ///< [count], row-major
  std::size_t count = 0;                  ///< rows * columns, unless the sender made an error
};

/// The size that a scan states, or 0 x 0 where it has another number of counts. Use it before allocating
/// memory for a scan from outside.
inline MatrixSize honestSize(const ScanView& scan) {
  return scan.count == scan.size.taxels() ? scan.size : MatrixSize{};
}

inline ScanView view(const Scan& scan) {
  return {scan.size, scan.full_scale, scan.counts.data(), scan.counts.size()};
}

/// Throws InputError where a matrix cannot have this size, the number of counts does not fit the size, or a
/// count is above full scale.
void requireSound(const ScanView& scan);

}  // namespace fsr::matrix
