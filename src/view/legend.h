#pragma once

#include <string>
#include <vector>

#include "fsr_pressure_map/view/image.h"
#include "fsr_pressure_map/view/pressure_scale.h"

namespace fsr::view {

/// What a bent mesh cannot say of itself.
struct Legend {
  PressureScale scale;
  std::string title = "gauge pressure";  ///< of the colour bar; its unit follows in brackets
  std::vector<std::string> lines;        ///< of text, on top, cut where they are too long
  bool marks = true;                     ///< with the key of the marks (taxel_look.h)
};

bool operator==(const Legend& a, const Legend& b);

/// Colour bar with unit and range, key of the marks, lines of text; one size for a number of lines.
Image drawLegend(const Legend& legend);

/// Draws a colour bar with its ticks; the bar fills `width` x `height` pixels from `corner`, labels stand to
/// the right of it.
void drawColourBar(const PressureScale& scale, Pixel corner, int width, int height, Colour ink, Image& image);

/// Draws the key of the marks from `corner`: `in_a_row` looks beside each other, `width` pixels apart, rows
/// kKeyRowHeight apart.
constexpr int kKeyRowHeight = 16;  // [pixels]
void drawKey(Pixel corner, int in_a_row, int width, Colour ink, Image& image);

}  // namespace fsr::view
