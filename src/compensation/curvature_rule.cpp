#include "fsr_pressure_map/compensation/curvature_tables.h"

#include <algorithm>
#include <cmath>

namespace fsr::compensation {

namespace {

// Slope between knots i and i + 1.
double secant(const std::vector<double>& x, const std::vector<double>& y, std::size_t i) {
  return (y[i + 1] - y[i]) / (x[i + 1] - x[i]);
}

// Slope of the monotone cubic at a knot: the harmonic mean of the secants, with the weights of Fritsch and
// Butland (1984); 0 if they differ in sign; at the ends the secant.
double slopeAt(const std::vector<double>& x, const std::vector<double>& y, std::size_t i) {
  if (i == 0) return secant(x, y, 0);
  if (i + 1 == x.size()) return secant(x, y, i - 1);
  const double before = secant(x, y, i - 1), after = secant(x, y, i);
  if (before * after <= 0) return 0.0;
  const double left = x[i] - x[i - 1], right = x[i + 1] - x[i];
  const double weight = (left + 2 * right) / (3 * (left + right));
  return before * after / (weight * after + (1 - weight) * before);
}

double cubic(const std::vector<double>& x, const std::vector<double>& y, std::size_t i, double at) {
  const double width = x[i + 1] - x[i], t = (at - x[i]) / width;
  const double from = slopeAt(x, y, i) * width, to = slopeAt(x, y, i + 1) * width;
  return y[i] +
         t * (from + t * (3 * (y[i + 1] - y[i]) - 2 * from - to + t * (2 * (y[i] - y[i + 1]) + from + to)));
}

}  // namespace

EffectLaw::Effect EffectLaw::at(double at) const {
  if (curvature.empty()) return {1.0, 0.0};
  if (at <= curvature.front()) return {gain.front(), offset.front()};
  if (!(at < curvature.back())) return {gain.back(), offset.back()};  // nor NaN
  const auto above = std::upper_bound(curvature.begin(), curvature.end(), at);
  const auto i = static_cast<std::size_t>(above - curvature.begin()) - 1;
  return {cubic(curvature, gain, i, at), cubic(curvature, offset, i, at)};
}

// P = gain(k) / straight gain * (straight P - straight offset) + offset(k)
EffectLaw::Effect straightening(const EffectLaw& law, double low, double high, double share, double at) {
  if (law.curvature.empty() || low == high) return {1.0, 0.0};
  const EffectLaw::Effect below = law.at(low), above = law.at(high), here = law.at(at);
  const double straight_gain = below.gain + share * (above.gain - below.gain);
  const double straight_offset = below.offset + share * (above.offset - below.offset);
  const double gain = here.gain / straight_gain;
  return {gain, here.offset - gain * straight_offset};
}

double UnseenDeviation::at(double asked) const {
  if (asked <= pressure.front()) return deviation.front();
  if (!(asked < pressure.back())) return deviation.back();  // nor NaN
  const auto above = std::upper_bound(pressure.begin(), pressure.end(), asked);
  const auto i = static_cast<std::size_t>(above - pressure.begin()) - 1;
  const double share = (asked - pressure[i]) / (pressure[i + 1] - pressure[i]);
  return deviation[i] + share * (deviation[i + 1] - deviation[i]);
}

}  // namespace fsr::compensation
