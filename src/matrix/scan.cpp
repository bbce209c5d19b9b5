#include "fsr_pressure_map/matrix/scan.h"

#include <algorithm>

#include "fsr_pressure_map/settings/input_error.h"

namespace fsr::matrix {

void requireSound(const ScanView& scan) {
  if (scan.size.taxels() == 0 || std::max(scan.size.rows, scan.size.columns) > kMaxMatrixSide) {
    throw settings::InputError("a scan has " + sizeText(scan.size) + " taxels, but must have 1 to " +
                               std::to_string(kMaxMatrixSide) + " rows and columns");
  }
  if (scan.count != scan.size.taxels()) {
    throw settings::InputError("a scan holds " + std::to_string(scan.count) + " counts, but its size is " +
                               sizeText(scan.size));
  }
  const std::uint16_t largest = *std::max_element(scan.counts, scan.counts + scan.count);
  if (scan.full_scale == 0 || largest > scan.full_scale) {
    throw settings::InputError("a scan holds a count of " + std::to_string(largest) +
                               ", but its full_scale is " + std::to_string(scan.full_scale));
  }
}

}  // namespace fsr::matrix
