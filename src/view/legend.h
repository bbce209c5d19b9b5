#pragma once

#include <string>
#include <vector>

#include "fsr_pressure_map/view/colour_map.h"
#include "fsr_pressure_map/view/image.h"

namespace fsr::view {

/// Content of a legend beside a bent mesh.
struct Legend {
  PressureScale scale;
  std::string title = "gauge pressure";  ///< of the colour bar; the unit is added in brackets
  std::vector<std::string> lines;        ///< text above the colour bar; long lines are cut off
  bool marks = true;                     ///< whether the key of the marks (taxel_look.h) is drawn
};

bool operator==(const Legend& a, const Legend& b);

/// Draws lines of text, a colour bar with unit and range, and the key of the marks. The size of the picture
/// depends only on the number of lines.
Image drawLegend(const Legend& legend);

/// Draws a colour bar with its ticks. The bar fills `width` x `height` pixels from `corner`; the labels are
/// to the right of it.
void drawColourBar(const PressureScale& scale, Pixel corner, int width, int height, Colour ink, Image& image);

/// Draws the key of the marks from `corner`: `in_a_row` marks beside each other, `width` pixels apart; rows
/// are kKeyRowHeight apart.
constexpr int kKeyRowHeight = 16;  // [pixels]
void drawKey(Pixel corner, int in_a_row, int width, Colour ink, Image& image);

/// Upper end of a scale that follows the data without flicker. It takes round values only (1, 2 or 5 times a
/// power of ten). It rises at once when a peak exceeds it. It falls to the next lower value only after all
/// peaks stayed below 80 % of that value for `patience`.
class AutoRange {
 public:
  /// `least`: smallest upper end [Pa]; `patience` [s].
  explicit AutoRange(double least = 10e3, double patience = 5.0);

  /// Adds the peak of one map [Pa] at `time` [s] and returns the scale's upper end [Pa]. A NaN peak is
  /// ignored. If the time jumps back (a looped bag), the wait for the next step down starts again.
  double update(double time, double peak);

 private:
  double least_;
  double patience_;
  double high_;
  double calm_since_ = 0;  // [s]
  bool calm_ = false;
};

}  // namespace fsr::view
