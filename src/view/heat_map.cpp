#include "fsr_pressure_map/view/heat_map.h"

#include <algorithm>
#include <cmath>

#include "fsr_pressure_map/settings/input_error.h"
#include "view/legend.h"
#include "view/sheet_mesh.h"
#include "view/taxel_look.h"

namespace fsr::view {

namespace {

constexpr int kMargin = 12;      // [pixels], as are the following lengths
constexpr int kLineHeight = 16;  // of text
constexpr int kBarWidth = 18;
constexpr int kBarGap = 16;
constexpr int kTickLength = 4;
constexpr int kLabelWidth = 6 * 7;  // of a label such as "-123.5": 6 characters of 7 pixels
constexpr int kKeySquare = 13;
constexpr int kMinLongerSide = 160;  // height that the colour bar needs
constexpr Colour kPaper{32, 32, 32};
constexpr Colour kInk{240, 240, 240};

int rounded(double value) {
  return static_cast<int>(std::lround(value));
}

Colour colourOf(const PressureScale& scale, double value) {
  return std::isnan(value) ? kNoReadingColour : scale.colour(value);
}

}  // namespace

const std::vector<float>& layerOf(const map::PressureMap& map, MapLayer layer) {
  return layer == MapLayer::kPressure ? map.pressure : map.deviation;
}

const char* name(MapLayer layer) {
  return layer == MapLayer::kPressure ? "gauge pressure" : "standard deviation";
}

void requireShowable(const map::PressureMap& map) {
  const std::size_t n = map.layout.size.taxels();
  if (n > 0 && map.pressure.size() == n && map.deviation.size() == n && map.flags.size() == n) return;
  throw settings::InputError(
      "a map of " + matrix::sizeText(map.layout.size) + " taxels has " + std::to_string(map.pressure.size()) +
      " pressures, " + std::to_string(map.deviation.size()) + " deviations and " +
      std::to_string(map.flags.size()) + " flags, but must have one of each for each taxel");
}

// Positions and lengths of the parts of the picture [pixels].
struct HeatMap::Frame {
  matrix::Layout layout;
  Pixel corner;       // top left of the matrix
  double pixels = 1;  // scale [pixels/m]
  int matrix_width = 0;
  int matrix_height = 0;
  int width = 0;
  int height = 0;

  int left(int column) const { return corner.x + rounded(column * layout.pitch_x * pixels); }
  int top(int row) const { return corner.y + rounded(row * layout.pitch_y * pixels); }
  Pixel at(double row, double column) const {
    return {corner.x + rounded((column + 0.5) * layout.pitch_x * pixels),
            corner.y + rounded((row + 0.5) * layout.pitch_y * pixels)};
  }
};

HeatMap::Frame HeatMap::frame(const matrix::Layout& layout, std::size_t lines) const {
  Frame frame;
  frame.layout = layout;
  const double width = layout.pitch_x * layout.size.columns;
  const double height = layout.pitch_y * layout.size.rows;
  frame.pixels = std::max(style_.longer_side, kMinLongerSide) / std::max(width, height);
  frame.matrix_width = std::max(rounded(width * frame.pixels), int{layout.size.columns});
  frame.matrix_height = std::max(rounded(height * frame.pixels), int{layout.size.rows});
  const int heading = kLineHeight * static_cast<int>(lines + 1);
  frame.corner = {kMargin, kMargin + heading + kLineHeight / 2};
  const int key_rows = 2;
  frame.width = frame.matrix_width + 2 * kMargin + kBarGap + kBarWidth + kTickLength + kLabelWidth;
  frame.height = frame.corner.y + std::max(frame.matrix_height, kMinLongerSide) + key_rows * kLineHeight +
                 kLineHeight / 2 + kMargin;
  int longest = 0;
  for (const TaxelLook look : markedLooks()) longest = std::max(longest, Image::textWidth(name(look)));
  frame.width = std::max(frame.width, 2 * (longest + kKeySquare + 24) + 2 * kMargin);
  return frame;
}

Pixel HeatMap::centre(const matrix::Layout& layout, matrix::TaxelIndex taxel, std::size_t lines) const {
  return frame(layout, lines).at(layout.row(taxel), layout.column(taxel));
}

Image HeatMap::draw(const map::PressureMap& map, const std::vector<std::string>& lines) const {
  requireShowable(map);
  requireSound(style_.scale);
  const Frame frame = this->frame(map.layout, lines.size());
  Image image(frame.width, frame.height, kPaper);
  Pixel at{kMargin, kMargin};
  for (const std::string& line : lines) {
    image.text(at, line, kInk);
    at.y += kLineHeight;
  }
  image.text(at, std::string(name(style_.layer)) + " [" + name(style_.scale.unit) + "]", kInk);
  drawTaxels(map, frame, image);
  drawMarks(map, frame, image);
  drawColourBar(style_.scale, {frame.corner.x + frame.matrix_width + kBarGap, frame.corner.y}, kBarWidth,
                std::max(frame.matrix_height, kMinLongerSide), kInk, image);
  drawKey({kMargin, frame.height - kMargin - 2 * kKeyRowHeight}, 2, frame.width / 2 - kMargin, kInk, image);
  return image;
}

void HeatMap::drawTaxels(const map::PressureMap& map, const Frame& frame, Image& image) const {
  const std::vector<float>& values = layerOf(map, style_.layer);
  const matrix::MatrixSize size = map.layout.size;
  if (style_.smooth) return drawSmoothly(SmoothLayer(values, size), size, frame, image);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const int row = map.layout.row({i});
    const int column = map.layout.column({i});
    image.fill({frame.left(column), frame.top(row)}, frame.left(column + 1) - frame.left(column),
               frame.top(row + 1) - frame.top(row), colourOf(style_.scale, double(values[i])));
  }
}

void HeatMap::drawSmoothly(const SmoothLayer& layer, matrix::MatrixSize size, const Frame& frame,
                           Image& image) const {
  std::vector<SmoothLayer::Place> columns;
  for (int x = 0; x < frame.matrix_width; ++x) {
    columns.push_back(layer.column((x + 0.5) / frame.matrix_width * size.columns - 0.5));
  }
  const PressureScale& scale = style_.scale;
  const std::uint8_t* table = colourTable(scale.colours);
  std::vector<double> values;
  std::vector<Colour> colours(columns.size());
  for (int y = 0; y < frame.matrix_height; ++y) {
    layer.alongRow(layer.row((y + 0.5) / frame.matrix_height * size.rows - 0.5), columns, values);
    for (std::size_t x = 0; x < values.size(); ++x) {
      colours[x] = std::isnan(values[x])
                       ? kNoReadingColour
                       : colourAt(table, (values[x] - scale.low) / (scale.high - scale.low));
    }
    image.setRow({frame.corner.x, frame.corner.y + y}, colours);
  }
}

void HeatMap::drawMarks(const map::PressureMap& map, const Frame& frame, Image& image) const {
  const std::vector<float>& values = layerOf(map, style_.layer);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const int row = map.layout.row({i});
    const int column = map.layout.column({i});
    const Colour ink = markColour(colourOf(style_.scale, double(values[i])));
    for (const Stroke& stroke : mark(lookOf(map.pressure[i], map.flags[i]))) {
      image.line(frame.at(row + stroke.from.y, column + stroke.from.x),
                 frame.at(row + stroke.to.y, column + stroke.to.x), ink, 2);
    }
  }
}

}  // namespace fsr::view
