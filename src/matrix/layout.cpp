#include "fsr_pressure_map/matrix/layout.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "fsr_pressure_map/matrix/curvature.h"
#include "fsr_pressure_map/matrix/scan.h"
#include "fsr_pressure_map/settings/input_error.h"

namespace fsr::matrix {

std::string sizeText(MatrixSize size) {
  return std::to_string(size.rows) + " x " + std::to_string(size.columns);
}

TaxelIndex Layout::index(std::uint16_t row, std::uint16_t column) const {
  return {std::size_t{row} * size.columns + column};
}

std::uint16_t Layout::row(TaxelIndex taxel) const {
  return static_cast<std::uint16_t>(taxel.value / size.columns);
}

std::uint16_t Layout::column(TaxelIndex taxel) const {
  return static_cast<std::uint16_t>(taxel.value % size.columns);
}

Position Layout::position(TaxelIndex taxel) const {
  return {pitch_x * (column(taxel) - 0.5 * (size.columns - 1)),
          pitch_y * (row(taxel) - 0.5 * (size.rows - 1))};
}

bool operator==(const Curvature& a, const Curvature& b) {
  return a.x == b.x && a.y == b.y && a.xy == b.xy;
}

double principalCurvature(const Curvature& curvature) {
  const double mean = 0.5 * (curvature.x + curvature.y);
  const double radius = std::hypot(0.5 * (curvature.x - curvature.y), curvature.xy);
  return mean >= 0 ? mean + radius : mean - radius;
}

void requireFit(const Surface& surface, MatrixSize size) {
  for (const std::size_t values : {surface.curvature.size(), surface.deviation.size()}) {
    if (values > 1 && values != size.taxels()) {
      throw settings::InputError("surface \"" + surface.name + "\" has " + std::to_string(values) +
                                 " values, but must have one, or one for each of the " +
                                 std::to_string(size.taxels()) + " taxels of a " + sizeText(size) +
                                 " matrix");
    }
  }
}

bool sameCondition(const Surface& a, const Surface& b) {
  return a.name == b.name && a.mount == b.mount && a.curvature == b.curvature;
}

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
