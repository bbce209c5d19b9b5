#include "fsr_pressure_map/view/map_layer.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fsr_pressure_map/settings/input_error.h"

namespace fsr {

namespace {

/// The two centres beside a coordinate and how far it is from the first to the second.
struct Between {
  int low, high;
  double part;
};

Between between(double coordinate, int count) {
  const double inside = std::clamp(coordinate, 0.0, double(count - 1));
  const int low = std::min(static_cast<int>(inside), std::max(count - 2, 0));
  return {low, std::min(low + 1, count - 1), inside - low};
}

}  // namespace

const std::vector<float>& layerOf(const PressureMap& map, MapLayer layer) {
  return layer == MapLayer::kPressure ? map.pressure : map.deviation;
}

const char* name(MapLayer layer) {
  return layer == MapLayer::kPressure ? "gauge pressure" : "standard deviation";
}

double SmoothLayer::at(double row, double column) const {
  const Between r = between(row, size_.rows);
  const Between c = between(column, size_.columns);
  const auto value = [&](int i, int j) {
    return double(values_[std::size_t(i) * size_.columns + std::size_t(j)]);
  };
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

void requireShowable(const PressureMap& map) {
  const std::size_t n = map.layout.size.taxels();
  if (n > 0 && map.pressure.size() == n && map.deviation.size() == n && map.flags.size() == n) return;
  throw InputError("a map of " + sizeText(map.layout.size) + " taxels has " +
                   std::to_string(map.pressure.size()) + " pressures, " +
                   std::to_string(map.deviation.size()) + " deviations and " +
                   std::to_string(map.flags.size()) + " flags, but must have one of each for each taxel");
}

}  // namespace fsr
