#include "view/auto_range.h"

#include <algorithm>
#include <cmath>

namespace fsr::view {

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
