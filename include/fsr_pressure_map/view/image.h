#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fsr_pressure_map/view/colour_map.h"

namespace fsr::view {

/// A point of an image [pixels] from its top left corner.
struct Pixel {
  int x = 0;
  int y = 0;
};

/// An rgb8 picture and the little drawing that legends need. What lies outside the picture is left out.
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
  /// Pixels to the right of `left`, itself the first.
  void setRow(Pixel left, const std::vector<Colour>& colours);
  /// `corner` is the top left one.
  void fill(Pixel corner, int width, int height, Colour colour);
  /// `thickness` pixels wide.
  void line(Pixel from, Pixel to, Colour colour, int thickness = 1);

  /// Draws ASCII text with its top left at `corner`; other bytes become '?'.
  void text(Pixel corner, const std::string& text, Colour colour);
  static int textWidth(const std::string& text);
  static constexpr int kTextHeight = 13;

 private:
  int width_ = 0;
  int height_ = 0;
  std::vector<std::uint8_t> bytes_;
};

/// The picture as the bytes of a PNG file. Throws InputError where memory or libpng fail.
std::string pngOf(const Image& image);

}  // namespace fsr::view
