#include "view/legend.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "view/taxel_look.h"

namespace fsr::view {

namespace {

constexpr Colour kLegendPaper{32, 32, 32};
constexpr Colour kLegendInk{240, 240, 240};
constexpr int kLegendMargin = 10;      // [pixels], as are the following lengths
constexpr int kLegendLineHeight = 16;  // of text
constexpr int kWidth = 206;
constexpr int kLegendBarWidth = 22;
constexpr int kBarHeight = 190;
constexpr int kKeyLeft = 94;  // right of the bar's labels
constexpr int kLegendTickLength = 4;
constexpr int kLegendKeySquare = 13;
constexpr int kMostTicks = 7;

int pixelOf(double value) {
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
    const int y = corner.y + std::min(height - 1, pixelOf((1 - part) * height));
    image.fill({corner.x + width, y}, kLegendTickLength, 1, ink);
    image.text({corner.x + width + kLegendTickLength + 3, y - Image::kTextHeight / 2}, tick.label, ink);
  }
}

void drawKey(Pixel corner, int in_a_row, int width, Colour ink, Image& image) {
  for (std::size_t i = 0; i < markedLooks().size(); ++i) {
    const TaxelLook look = markedLooks()[i];
    const int n = static_cast<int>(i);
    const Pixel square{corner.x + width * (n % in_a_row), corner.y + kKeyRowHeight * (n / in_a_row)};
    const Colour under = look == TaxelLook::kNoReading ? kNoReadingColour : Colour{72, 72, 72};
    image.fill(square, kLegendKeySquare, kLegendKeySquare, under);
    const auto at = [&](matrix::Position p) {
      return Pixel{square.x + pixelOf((p.x + 0.5) * (kLegendKeySquare - 1)),
                   square.y + pixelOf((p.y + 0.5) * (kLegendKeySquare - 1))};
    };
    for (const Stroke& stroke : mark(look)) image.line(at(stroke.from), at(stroke.to), ink, 1);
    image.text({square.x + kLegendKeySquare + 6, square.y}, name(look), ink);
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
  const int heading = kLegendLineHeight * static_cast<int>(legend.lines.size() + 1);
  Image image(kWidth, 2 * kLegendMargin + heading + kLegendLineHeight + kBarHeight, kLegendPaper);
  Pixel at{kLegendMargin, kLegendMargin};
  for (const std::string& line : legend.lines) {
    image.text(at, line, kLegendInk);
    at.y += kLegendLineHeight;
  }
  image.text(at, legend.title + " [" + name(legend.scale.unit) + "]", kLegendInk);
  at.y += kLegendLineHeight + kLegendLineHeight / 2;
  drawColourBar(legend.scale, at, kLegendBarWidth, kBarHeight, kLegendInk, image);
  const int key_height = kKeyRowHeight * static_cast<int>(markedLooks().size());
  if (legend.marks) drawKey({kKeyLeft, at.y + kBarHeight - key_height}, 1, 0, kLegendInk, image);
  return image;
}

namespace {

constexpr double kStepDownBelow = 0.8;  // share of the next lower end

// The value at `place` of the sequence ..., 1, 2, 5, 10, 20, 50, ...; place 0 is 1.
double roundValue(int place) {
  static const double digits[] = {1, 2, 5};
  const int power = static_cast<int>(std::floor(place / 3.0));
  return digits[place - 3 * power] * std::pow(10.0, power);
}

int placeOfAtLeast(double value) {
  int place = 3 * static_cast<int>(std::floor(std::log10(value)));
  while (roundValue(place) < value * (1 - 1e-12)) ++place;
  return place;
}

}  // namespace

AutoRange::AutoRange(double least, double patience)
    : least_(roundValue(placeOfAtLeast(least))), patience_(patience), high_(least_) {}

double AutoRange::update(double time, double peak) {
  if (std::isnan(peak)) return high_;
  if (peak > high_) {
    high_ = roundValue(placeOfAtLeast(peak));
    calm_ = false;
    return high_;
  }
  const double lower = roundValue(placeOfAtLeast(high_) - 1);
  const bool was_calm = calm_ && time >= calm_since_;
  calm_ = lower >= least_ && peak < kStepDownBelow * lower;
  if (calm_ && !was_calm) calm_since_ = time;
  if (calm_ && time - calm_since_ >= patience_) {
    high_ = lower;
    calm_ = false;
  }
  return high_;
}

}  // namespace fsr::view
