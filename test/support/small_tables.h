#pragma once

#include <vector>

#include "fsr_pressure_map/compensation/curvature_tables.h"

namespace test_support {

/// Pressure of a code in the tables of smallTables() [Pa]. Each taxel, class and code has a different value,
/// which is exact in a float.
inline float knownPressure(std::size_t taxel, std::size_t curvature_class, std::size_t code) {
  return static_cast<float>(100 * code + 10 * curvature_class) + static_cast<float>(taxel) / 128;
}

inline float knownDeviation(std::size_t taxel, std::size_t curvature_class, std::size_t code) {
  return static_cast<float>(1000 + taxel) + static_cast<float>(curvature_class) / 8 +
         static_cast<float>(code) / 16;
}

constexpr std::uint16_t kLowestTrained = 20;
constexpr std::uint16_t kMarginAtTop = 95;  // number of codes below full scale that training did not reach

/// A calibration small enough to check by hand: one class for each of `curvatures` [1/m], ascending.
inline fsr::compensation::CurvatureTables smallTables(fsr::matrix::MatrixSize size,
                                                      const std::vector<double>& curvatures,
                                                      std::uint16_t full_scale = 1023) {
  fsr::compensation::CurvatureTables tables;
  tables.size = size;
  tables.full_scale = full_scale;
  tables.curvature_low = curvatures.front();
  tables.curvature_high = curvatures.back();
  for (const double curvature : curvatures) {
    tables.classes.push_back({"surface_" + std::to_string(tables.classes.size()), {curvature}});
  }
  for (std::size_t taxel = 0; taxel < size.taxels(); ++taxel) {
    for (std::size_t k = 0; k < curvatures.size(); ++k) {
      fsr::regression::CodeTable table;
      for (std::size_t code = 0; code <= full_scale; ++code) {
        table.pressure.push_back(knownPressure(taxel, k, code));
        table.deviation.push_back(knownDeviation(taxel, k, code));
        table.support.push_back(1.0f);
      }
      table.lowest = kLowestTrained;
      table.highest = static_cast<std::uint16_t>(full_scale - kMarginAtTop);
      tables.tables.push_back(table);
    }
  }
  return tables;
}

}  // namespace test_support
