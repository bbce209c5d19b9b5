#include "map/fill.h"

#include <algorithm>
#include <cmath>

namespace fsr::map {

namespace {

constexpr std::uint16_t kNoSource =
    taxel_flag::kDead | taxel_flag::kStuck | taxel_flag::kMasked | taxel_flag::kFilled;

/// Weighted sums over the valid neighbours.
struct Sums {
  double weight = 0;
  double pressure = 0;  // [Pa]
  double squared = 0;   // of pressure [Pa^2]
  double variance = 0;  // of the readings themselves [Pa^2]

  void add(double w, double value, double deviation) {
    weight += w;
    pressure += w * value;
    squared += w * value * value;
    variance += w * deviation * deviation;
  }
};

Sums goodNeighbours(const PressureMap& map, std::size_t taxel) {
  const matrix::Layout& layout = map.layout;
  const int row = layout.row({taxel});
  const int column = layout.column({taxel});
  Sums sums;
  for (int r = std::max(row - 1, 0); r <= std::min(row + 1, layout.size.rows - 1); ++r) {
    for (int c = std::max(column - 1, 0); c <= std::min(column + 1, layout.size.columns - 1); ++c) {
      const std::size_t i = std::size_t(r) * layout.size.columns + std::size_t(c);
      if (i == taxel || (map.flags[i] & kNoSource) != 0) continue;
      const double distance = std::hypot((r - row) * layout.pitch_y, (c - column) * layout.pitch_x);
      sums.add(1.0 / (distance * distance), map.pressure[i], map.deviation[i]);
    }
  }
  return sums;
}

}  // namespace

void fillFromNeighbours(PressureMap& map, const std::vector<std::size_t>& taxels) noexcept {
  for (const std::size_t taxel : taxels) {
    const Sums sums = goodNeighbours(map, taxel);
    if (!(sums.weight > 0)) continue;
    const double mean = sums.pressure / sums.weight;
    const double scatter = std::max(0.0, sums.squared / sums.weight - mean * mean);
    map.pressure[taxel] = static_cast<float>(mean);
    map.deviation[taxel] = static_cast<float>(std::sqrt(sums.variance / sums.weight + scatter));
    map.flags[taxel] = static_cast<std::uint16_t>(map.flags[taxel] | taxel_flag::kFilled);
  }
}

}  // namespace fsr::map
