#pragma once

#include <vector>

#include "fsr_pressure_map/map/pressure_map.h"
#include "fsr_pressure_map/view/pressure_scale.h"

namespace fsr {

/// What of a map is shown in colour.
enum class MapLayer { kPressure, kDeviation };

/// The layer's values [rows x columns], row-major [Pa], NaN = no reading.
const std::vector<float>& layerOf(const PressureMap& map, MapLayer layer);

/// "pressure, gauge" or "standard deviation": what a legend calls it.
const char* name(MapLayer layer);

/// The layer's value at taxel coordinates (0, 0 = centre of taxel 0, 0), bilinear between centres, ends
/// beyond the outer centres. A taxel without a value gives none, and takes no part in its neighbours'.
class SmoothLayer {
 public:
  SmoothLayer(const std::vector<float>& values, MatrixSize size) : values_(values), size_(size) {}
  double at(double row, double column) const;

 private:
  const std::vector<float>& values_;
  MatrixSize size_;
};

/// Throws InputError for a map without taxels or with arrays that do not fit its layout.
void requireShowable(const PressureMap& map);

}  // namespace fsr
