#include "view/smooth_layer.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fsr::view {

SmoothLayer::Place SmoothLayer::place(double coordinate, int count) {
  const double inside = std::clamp(coordinate, 0.0, double(count - 1));
  const int low = std::min(static_cast<int>(inside), std::max(count - 2, 0));
  return {low, std::min(low + 1, count - 1), inside - low};
}

double SmoothLayer::at(const Place& r, const Place& c) const {
  const double first = value(r.low, c.low) * (1 - c.part) + value(r.low, c.high) * c.part;
  const double second = value(r.high, c.low) * (1 - c.part) + value(r.high, c.high) * c.part;
  const double result = first * (1 - r.part) + second * r.part;
  return std::isnan(result) ? patched(r, c) : result;
}

void SmoothLayer::alongRow(const Place& row, const std::vector<Place>& columns,
                           std::vector<double>& result) const {
  std::vector<double> between(std::size_t{size_.columns});  // interpolated between the two rows
  for (int c = 0; c < size_.columns; ++c) {
    between[std::size_t(c)] = value(row.low, c) * (1 - row.part) + value(row.high, c) * row.part;
  }
  result.resize(columns.size());
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const Place& c = columns[i];
    const double blend = between[std::size_t(c.low)] * (1 - c.part) + between[std::size_t(c.high)] * c.part;
    result[i] = std::isnan(blend) ? at(row, c) : blend;
  }
}

// Interpolation if some of the four taxels have no value: NaN if the nearest has none, else from the others.
double SmoothLayer::patched(const Place& r, const Place& c) const {
  if (std::isnan(value(r.part < 0.5 ? r.low : r.high, c.part < 0.5 ? c.low : c.high))) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  double sum = 0, weight = 0;
  const auto add = [&](int i, int j, double w) {
    if (std::isnan(value(i, j))) return;
    sum += w * value(i, j);
    weight += w;
  };
  add(r.low, c.low, (1 - r.part) * (1 - c.part));
  add(r.low, c.high, (1 - r.part) * c.part);
  add(r.high, c.low, r.part * (1 - c.part));
  add(r.high, c.high, r.part * c.part);
  return sum / weight;
}

}  // namespace fsr::view
