#pragma once

#include <string>
#include <vector>

#include "fsr_pressure_map/map/pressure_map.h"
#include "fsr_pressure_map/view/image.h"
#include "fsr_pressure_map/view/map_layer.h"
#include "fsr_pressure_map/view/pressure_scale.h"

namespace fsr::view {

/// How a heat map looks; every default stands here.
struct HeatMapStyle {
  PressureScale scale;
  MapLayer layer = MapLayer::kPressure;
  bool smooth = false;    ///< colours run over from taxel to taxel; false: a square each
  int longer_side = 400;  ///< of the matrix in the picture, about [pixels], 64 to 4096
};

/// Draws heat maps: the matrix as its arrays are printed, row 0 on top (the sheet seen from its back), marks
/// on taxels that are not to be believed as they stand (taxel_look.h), colour bar with unit and range, the
/// key of the marks, and lines of text above.
class HeatMap {
 public:
  explicit HeatMap(const HeatMapStyle& style) : style_(style) {}

  void setScale(const PressureScale& scale) { style_.scale = scale; }
  const HeatMapStyle& style() const { return style_; }

  /// Width and height depend on the matrix, the style and the number of lines alone. Throws InputError for
  /// a map without taxels or with arrays that do not fit its layout.
  Image draw(const map::PressureMap& map, const std::vector<std::string>& lines = {}) const;

  /// Where a taxel's centre lies in draw()'s picture.
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
