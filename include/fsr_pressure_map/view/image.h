#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fsr_pressure_map/view/colour_map.h"

namespace fsr::view {

/// A point of an image [pixels], counted from the top left corner.
struct Pixel {
  int x = 0;
  int y = 0;
};

/// An rgb8 picture with simple drawing functions. Pixels outside the picture are ignored.
class Image {
 public:
  Image() = default;
  Image(int width, int height, Colour background);

  int width() const { return width_; }
  int height() const { return height_; }
  /// [height x width x 3], row-major from the top, red, green, blue.
  const std::vector<std::uint8_t>& bytes() const { return bytes_; }
  std::vector<std::uint8_t>& bytes() { return bytes_; }

  Colour at(Pixel pixel) const;
  void set(Pixel pixel, Colour colour);
  /// Sets the pixels from `left` to the right, one for each colour.
  void setRow(Pixel left, const std::vector<Colour>& colours);
  /// Fills a rectangle; `corner` is its top left corner.
  void fill(Pixel corner, int width, int height, Colour colour);
  /// Draws a straight line, `thickness` pixels wide.
  void line(Pixel from, Pixel to, Colour colour, int thickness = 1);

  /// Draws ASCII text with its top left corner at `corner`. Other bytes are drawn as '?'.
  void text(Pixel corner, const std::string& text, Colour colour);
  static int textWidth(const std::string& text);
  static constexpr int kTextHeight = 13;

 private:
  int width_ = 0;
  int height_ = 0;
  std::vector<std::uint8_t> bytes_;
};

}  // namespace fsr::view
