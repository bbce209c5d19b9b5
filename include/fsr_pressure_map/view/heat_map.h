#pragma once

#include <string>
#include <vector>

#include "fsr_pressure_map/map/pressure_map.h"
#include "fsr_pressure_map/view/colour_map.h"
#include "fsr_pressure_map/view/image.h"

namespace fsr::view {

class SmoothLayer;  // src/view/smooth_layer.h

/// Quantity of a map that is shown in colour.
enum class MapLayer { kPressure, kDeviation };

/// The layer's values [rows x columns], row-major [Pa], NaN = no reading.
const std::vector<float>& layerOf(const map::PressureMap& map, MapLayer layer);

/// Name for legends: "gauge pressure" or "standard deviation".
const char* name(MapLayer layer);

/// Throws InputError for a map without taxels or with arrays that do not fit its layout.
void requireShowable(const map::PressureMap& map);

/// Style of a heat map, with all defaults.
struct HeatMapStyle {
  PressureScale scale;
  MapLayer layer = MapLayer::kPressure;
  bool smooth = false;    ///< true: colours are interpolated between taxels; false: one square for each taxel
  int longer_side = 400;  ///< longer side of the matrix in the picture, approximately [pixels], 64 to 4096
};

/// Draws heat maps. Row 0 is on top, as arrays are printed (the sheet seen from its back). Taxels whose value
/// is not reliable have a mark: a cross for no reading, an open square for saturated, two diagonals for
/// extrapolated. A picture also has a colour bar with unit and range, the key of the marks, and lines of text
/// above.
class HeatMap {
 public:
  explicit HeatMap(const HeatMapStyle& style) : style_(style) {}

  /// Width and height of the picture depend only on the matrix, the style and the number of lines. Throws
  /// InputError for a map without taxels or with arrays that do not fit its layout.
  Image draw(const map::PressureMap& map, const std::vector<std::string>& lines = {}) const;

  /// Position of a taxel's centre in the picture of draw().
  Pixel centre(const matrix::Layout& layout, matrix::TaxelIndex taxel, std::size_t lines) const;

 private:
  struct Frame;
  Frame frame(const matrix::Layout& layout, std::size_t lines) const;
  void drawTaxels(const map::PressureMap& map, const Frame& frame, Image& image) const;
  void drawSmoothly(const SmoothLayer& layer, matrix::MatrixSize size, const Frame& frame,
                    Image& image) const;
  void drawMarks(const map::PressureMap& map, const Frame& frame, Image& image) const;

  HeatMapStyle style_;
};

}  // namespace fsr::view
