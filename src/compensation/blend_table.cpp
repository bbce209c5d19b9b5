#include "compensation/blend_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "fsr_pressure_map/compensation/curvature_tables.h"

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

namespace {

// Weights below exp(-40) of the largest are ignored.
constexpr float kNegligibleExponent = 40.0f;

std::size_t nearestOf(double at, const std::vector<double>& curvature) {
  std::size_t best = 0;
  double least = INFINITY;
  for (std::size_t k = 0; k < curvature.size(); ++k) {
    const double distance = std::abs(curvature[k] - at);
    if (!(distance < least)) continue;  // also skips NaN
    least = distance;
    best = k;
  }
  return best;
}

// The nearest class on one side of `from`, or `from` if there is none. `sign` +1 = above, -1 = below.
std::size_t nextOf(std::size_t from, double sign, const std::vector<double>& curvature) {
  std::size_t best = from;
  double least = INFINITY;
  for (std::size_t k = 0; k < curvature.size(); ++k) {
    const double distance = sign * (curvature[k] - curvature[from]);
    if (!(distance > 0 && distance < least)) continue;
    least = distance;
    best = k;
  }
  return best;
}

void chosenPressure(const TableEntry* table, std::size_t codes, TableEntry* out) {
  for (std::size_t code = 0; code < codes; ++code) out[code].pressure = table[code].pressure;
}

void interpolatedPressure(const EffectLaw& law, const TaxelTables& tables, const CurvaturePlace& place,
                          double at, TableEntry* out) {
  const TableEntry* const below = tables.table[place.below];
  const TableEntry* const above = tables.table[place.above];
  const EffectLaw::Effect bend =
      straightening(law, tables.curvature[place.below], tables.curvature[place.above], place.share, at);
  const auto gain = static_cast<float>(bend.gain), offset = static_cast<float>(bend.offset);
  const auto share = static_cast<float>(place.share);
  for (std::size_t code = 0; code < tables.codes; ++code) {
    const float straight = below[code].pressure + share * (above[code].pressure - below[code].pressure);
    out[code].pressure = gain * straight + offset;
  }
}

// Number of codes that are blended together, small enough for their sums to stay in the first-level cache.
constexpr std::size_t kBlock = 256;

struct KernelSums {
  std::array<float, kBlock> largest, sum, weight;
};

// Quotients of kernel sums that are stored as logarithms; the largest is subtracted from all.
void kernelBlock(double precision, const TaxelTables& tables, double at, std::size_t begin,
                 std::size_t number, KernelSums& sums) {
  sums.largest.fill(-std::numeric_limits<float>::infinity());
  sums.sum.fill(0.0f);
  sums.weight.fill(0.0f);
  const auto exponent = [&](std::size_t k) {
    const double distance = at - tables.curvature[k];
    return static_cast<float>(precision * distance * distance);
  };
  for (std::size_t k = 0; k < tables.curvature.size(); ++k) {
    const float away = exponent(k);
    if (std::isnan(away)) continue;
    const float* const log_weight = tables.log_weight[k] + begin;
    for (std::size_t i = 0; i < number; ++i)
      sums.largest[i] = std::max(sums.largest[i], log_weight[i] - away);
  }
  for (std::size_t k = 0; k < tables.curvature.size(); ++k) {
    const float away = exponent(k);
    const float* const log_weight = tables.log_weight[k] + begin;
    const TableEntry* const entry = tables.table[k] + begin;
    for (std::size_t i = 0; i < number; ++i) {
      const float below = sums.largest[i] - (log_weight[i] - away);
      if (!(below < kNegligibleExponent)) continue;  // also skips classes that are left out (NaN)
      const float share = std::exp(-below);
      sums.sum[i] += share * entry[i].pressure;
      sums.weight[i] += share;
    }
  }
}

void kernelPressure(double length_scale, const TaxelTables& tables, double at, TableEntry* out) {
  const double precision = 0.5 / (length_scale * length_scale);
  KernelSums sums;
  for (std::size_t begin = 0; begin < tables.codes; begin += kBlock) {
    const std::size_t number = std::min(kBlock, tables.codes - begin);
    kernelBlock(precision, tables, at, begin, number, sums);
    for (std::size_t i = 0; i < number; ++i) out[begin + i].pressure = sums.sum[i] / sums.weight[i];
  }
}

// Variances: that of the neighbours, interpolated, and that of a curvature without training data.
void spreadDeviation(const UnseenDeviation& unseen, const TaxelTables& tables, const CurvaturePlace& place,
                     TableEntry* out) {
  const TableEntry* const below = tables.table[place.below];
  const TableEntry* const above = tables.table[place.above];
  const TableEntry* const inner = tables.table[place.inner];
  const auto share = static_cast<float>(place.share), beyond = static_cast<float>(place.beyond);
  const bool known = !unseen.pressure.empty();
  const auto missing = [&](std::size_t k, std::size_t code, float weight) {
    const bool beyond_training = !tables.highest.empty() && code > tables.highest[k];
    return beyond_training ? weight * (above[code].pressure - below[code].pressure) : 0.0F;
  };
  const float between = 4 * share * (1 - share), outside = std::min(1.0f, 2 * beyond);
  for (std::size_t code = 0; code < tables.codes; ++code) {
    const float low = below[code].deviation, high = above[code].deviation;
    const float half = 0.5f * (above[code].pressure - below[code].pressure);
    const float off = known ? static_cast<float>(unseen.at(out[code].pressure)) : half;
    const float lack = missing(place.below, code, 1 - share) + missing(place.above, code, share);
    const float away = beyond * (below[code].pressure - inner[code].pressure);
    out[code].deviation = std::sqrt((1 - share) * low * low + share * high * high +
                                    (between + outside * outside) * off * off + away * away + lack * lack);
  }
}

// The pressure of a code at a curvature as a sum of two classes.
struct TwoClasses {
  const TableEntry* first;
  const TableEntry* second;
  float weight;  // of the second one

  TwoClasses(const TaxelTables& tables, double at) {
    const CurvaturePlace place = placeOf(at, tables.curvature);
    first = tables.table[place.below];
    second = tables.table[place.beyond != 0 ? place.inner : place.above];
    weight = static_cast<float>(place.beyond != 0 ? -place.beyond : place.share);
  }
  float pressure(std::size_t code) const {
    return first[code].pressure + weight * (second[code].pressure - first[code].pressure);
  }
};

}  // namespace

CurvaturePlace placeOf(double at, const std::vector<double>& curvature) {
  CurvaturePlace place;
  const std::size_t nearest = nearestOf(at, curvature);
  const double from_nearest = at - curvature[nearest];
  const double sign = from_nearest >= 0 ? 1.0 : -1.0;
  const std::size_t other = from_nearest == 0 ? nearest : nextOf(nearest, sign, curvature);
  place.below = place.above = place.inner = nearest;
  if (other != nearest) {
    place.below = sign > 0 ? nearest : other;
    place.above = sign > 0 ? other : nearest;
    place.share = (at - curvature[place.below]) / (curvature[place.above] - curvature[place.below]);
    place.inner = place.below;
    return place;
  }
  place.inner = nextOf(nearest, -sign, curvature);
  if (place.inner != nearest) place.beyond = from_nearest / (curvature[nearest] - curvature[place.inner]);
  return place;
}

void blendTable(const CurvatureRule& rule, double length_scale, const TaxelTables& tables, double at,
                std::size_t chosen, TableEntry* out) {
  const CurvaturePlace place = placeOf(at, tables.curvature);
  if (rule.blend == BlendRule::kKernel) {
    kernelPressure(length_scale, tables, at, out);
  } else if (rule.blend == BlendRule::kInterpolate) {
    interpolatedPressure(rule.law, tables, place, at, out);
  } else {
    chosenPressure(tables.table[chosen], tables.codes, out);
  }
  spreadDeviation(rule.unseen, tables, place, out);
}

void addCurvatureDeviation(const TaxelTables& tables, double at, double deviation, TableEntry* out) {
  const TwoClasses flatter(tables, at - deviation), rounder(tables, at + deviation);
  for (std::size_t code = 0; code < tables.codes; ++code) {
    const float half = (rounder.pressure(code) - flatter.pressure(code)) / 2;
    out[code].deviation = std::hypot(out[code].deviation, half);
  }
}

}  // namespace fsr::compensation
