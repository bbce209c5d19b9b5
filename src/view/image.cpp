#include "fsr_pressure_map/view/image.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "view/tables.h"

namespace fsr::view {

namespace {

constexpr int kGlyphWidth = 7;
constexpr int kGlyphRows = Image::kTextHeight;

const std::uint8_t* glyph(char c) {
  const int code = c >= 32 && c < 127 ? c : '?';
  return tables::kFont + (code - 32) * kGlyphRows;
}

}  // namespace

Image::Image(int width, int height, Colour background)
    : width_(width), height_(height), bytes_(std::size_t(width) * std::size_t(height) * 3) {
  fill({0, 0}, width, height, background);
}

Colour Image::at(Pixel pixel) const {
  if (pixel.x < 0 || pixel.y < 0 || pixel.x >= width_ || pixel.y >= height_) return {};
  const std::uint8_t* rgb = bytes_.data() + 3 * (std::size_t(pixel.y) * width_ + pixel.x);
  return {rgb[0], rgb[1], rgb[2]};
}

void Image::set(Pixel pixel, Colour colour) {
  if (pixel.x < 0 || pixel.y < 0 || pixel.x >= width_ || pixel.y >= height_) return;
  std::uint8_t* rgb = bytes_.data() + 3 * (std::size_t(pixel.y) * width_ + pixel.x);
  rgb[0] = colour.red;
  rgb[1] = colour.green;
  rgb[2] = colour.blue;
}

void Image::setRow(Pixel left, const std::vector<Colour>& colours) {
  if (left.y < 0 || left.y >= height_) return;
  const std::size_t first = std::size_t(std::max(0, -left.x));
  const std::size_t end = std::min(colours.size(), std::size_t(std::max(0, width_ - left.x)));
  if (first >= end) return;
  std::uint8_t* rgb = bytes_.data() + 3 * (std::size_t(left.y) * width_ + std::size_t(left.x + int(first)));
  for (std::size_t i = first; i < end; ++i, rgb += 3) {
    rgb[0] = colours[i].red;
    rgb[1] = colours[i].green;
    rgb[2] = colours[i].blue;
  }
}

void Image::fill(Pixel corner, int width, int height, Colour colour) {
  const int left = std::max(corner.x, 0), right = std::min(corner.x + width, width_);
  const int top = std::max(corner.y, 0), bottom = std::min(corner.y + height, height_);
  for (int y = top; y < bottom; ++y) {
    std::uint8_t* rgb = bytes_.data() + 3 * (std::size_t(y) * width_ + left);
    for (int x = left; x < right; ++x, rgb += 3) {
      rgb[0] = colour.red;
      rgb[1] = colour.green;
      rgb[2] = colour.blue;
    }
  }
}

void Image::line(Pixel from, Pixel to, Colour colour, int thickness) {
  const int steps = std::max({std::abs(to.x - from.x), std::abs(to.y - from.y), 1});
  for (int i = 0; i <= steps; ++i) {
    const int x = static_cast<int>(std::lround(from.x + double(to.x - from.x) * i / steps));
    const int y = static_cast<int>(std::lround(from.y + double(to.y - from.y) * i / steps));
    fill({x - (thickness - 1) / 2, y - (thickness - 1) / 2}, thickness, thickness, colour);
  }
}

void Image::text(Pixel corner, const std::string& text, Colour colour) {
  for (const char c : text) {
    const std::uint8_t* rows = glyph(c);
    for (int y = 0; y < kGlyphRows; ++y) {
      for (int x = 0; x < kGlyphWidth; ++x) {
        if ((rows[y] >> x & 1) != 0) set({corner.x + x, corner.y + y}, colour);
      }
    }
    corner.x += kGlyphWidth;
  }
}

int Image::textWidth(const std::string& text) {
  return kGlyphWidth * static_cast<int>(text.size());
}

}  // namespace fsr::view
