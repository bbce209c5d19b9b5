#include "view/legend.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "view/taxel_look.h"

namespace fsr::view {

namespace {

constexpr Colour kPaper{32, 32, 32};
constexpr Colour kInk{240, 240, 240};
constexpr int kMargin = 10;      // [pixels], as are the following lengths
constexpr int kLineHeight = 16;  // of text
constexpr int kWidth = 206;
constexpr int kBarWidth = 22;
constexpr int kBarHeight = 190;
constexpr int kKeyLeft = 94;  // right of the bar's labels
constexpr int kTickLength = 4;
constexpr int kKeySquare = 13;
constexpr int kMostTicks = 7;

int rounded(double value) {
  return static_cast<int>(std::lround(value));
}

}  // namespace

void drawColourBar(const PressureScale& scale, Pixel corner, int width, int height, Colour ink,
                   Image& image) {
  for (int y = 0; y < height; ++y) {
    image.fill({corner.x, corner.y + y}, width, 1, colourAt(scale.colours, 1 - (y + 0.5) / height));
  }
  for (const Tick& tick : ticks(scale, kMostTicks)) {
    const double part = (tick.pressure - scale.low) / (scale.high - scale.low);
    const int y = corner.y + std::min(height - 1, rounded((1 - part) * height));
    image.fill({corner.x + width, y}, kTickLength, 1, ink);
    image.text({corner.x + width + kTickLength + 3, y - Image::kTextHeight / 2}, tick.label, ink);
  }
}

void drawKey(Pixel corner, int in_a_row, int width, Colour ink, Image& image) {
  for (std::size_t i = 0; i < markedLooks().size(); ++i) {
    const TaxelLook look = markedLooks()[i];
    const int n = static_cast<int>(i);
    const Pixel square{corner.x + width * (n % in_a_row), corner.y + kKeyRowHeight * (n / in_a_row)};
    const Colour under = look == TaxelLook::kNoReading ? kNoReadingColour : Colour{72, 72, 72};
    image.fill(square, kKeySquare, kKeySquare, under);
    const auto at = [&](matrix::Position p) {
      return Pixel{square.x + rounded((p.x + 0.5) * (kKeySquare - 1)),
                   square.y + rounded((p.y + 0.5) * (kKeySquare - 1))};
    };
    for (const Stroke& stroke : mark(look)) image.line(at(stroke.from), at(stroke.to), ink, 1);
    image.text({square.x + kKeySquare + 6, square.y}, name(look), ink);
  }
}

bool operator==(const Legend& a, const Legend& b) {
  const auto parts = [](const Legend& legend) {
    const PressureScale& scale = legend.scale;
    return std::tie(scale.low, scale.high, scale.unit, scale.colours, legend.title, legend.lines,
                    legend.marks);
  };
  return parts(a) == parts(b);
}

Image drawLegend(const Legend& legend) {
  requireSound(legend.scale);
  const int heading = kLineHeight * static_cast<int>(legend.lines.size() + 1);
  Image image(kWidth, 2 * kMargin + heading + kLineHeight + kBarHeight, kPaper);
  Pixel at{kMargin, kMargin};
  for (const std::string& line : legend.lines) {
    image.text(at, line, kInk);
    at.y += kLineHeight;
  }
  image.text(at, legend.title + " [" + name(legend.scale.unit) + "]", kInk);
  at.y += kLineHeight + kLineHeight / 2;
  drawColourBar(legend.scale, at, kBarWidth, kBarHeight, kInk, image);
  const int key_height = kKeyRowHeight * static_cast<int>(markedLooks().size());
  if (legend.marks) drawKey({kKeyLeft, at.y + kBarHeight - key_height}, 1, 0, kInk, image);
  return image;
}

}  // namespace fsr::view
