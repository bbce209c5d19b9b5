#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <tuple>

#include "fsr_pressure_map/settings/input_error.h"
#include "regression/forest/forest_tree.h"

namespace fsr::regression {

namespace {

// Integers up to this are exact in a double.
constexpr double kExactInteger = 9007199254740992.0;  // 2^53

struct Reading {
  FixedPressure pressure;
  std::uint16_t code;
  std::uint8_t curvature;
};

std::vector<double> distinct(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  if (values.size() > kMostForestCurvatures) {
    throw settings::InputError("a forest on curvature is to train on " + std::to_string(values.size()) +
                               " different curvatures, but can on " + std::to_string(kMostForestCurvatures) +
                               " at most; pool them to classes");
  }
  return values;
}

// Sorts by code with one counting pass, then the few readings of each code by comparison.
std::vector<Reading> sorted(const CodeSamples& training, const std::vector<double>& curvatures) {
  std::vector<std::size_t> place(training.full_scale + 2u, 0);
  for (const std::uint16_t code : training.code) ++place[code + 1u];
  std::partial_sum(place.begin(), place.end(), place.begin());
  std::vector<Reading> readings(training.size());
  for (std::size_t i = 0; i < training.size(); ++i) {
    const auto found = curvatures.size() == 1
                           ? curvatures.begin()
                           : std::lower_bound(curvatures.begin(), curvatures.end(), training.curvature[i]);
    readings[place[training.code[i]]++] = {training.pressure[i], training.code[i],
                                           static_cast<std::uint8_t>(found - curvatures.begin())};
  }
  const auto before = [](const Reading& a, const Reading& b) {
    return std::tie(a.curvature, a.pressure) < std::tie(b.curvature, b.pressure);
  };
  std::size_t begin = 0;
  for (std::size_t code = 0; code + 1 < place.size(); begin = place[code++]) {
    std::sort(readings.begin() + static_cast<std::ptrdiff_t>(begin),
              readings.begin() + static_cast<std::ptrdiff_t>(place[code]), before);
  }
  return readings;
}

FixedPressure meanOf(const std::vector<FixedPressure>& pressure) {
  Int128 sum = 0;
  for (const FixedPressure p : pressure) sum += p;
  return static_cast<FixedPressure>(sum / static_cast<std::int64_t>(pressure.size()));
}

// Number of lowest bits to drop so that a sum of all readings is exact in a double: 0 for 10,000 readings of
// 600 kPa.
int bitsTooMany(const std::vector<FixedPressure>& pressure, FixedPressure centre) {
  const auto [low, high] = std::minmax_element(pressure.begin(), pressure.end());
  double largest = static_cast<double>(std::max(centre - *low, *high - centre));
  largest *= static_cast<double>(pressure.size());
  int bits = 0;
  for (; largest >= kExactInteger; largest /= 2) ++bits;
  return bits;
}

// Entries by number of readings.
std::vector<std::uint32_t> bySize(const std::vector<std::size_t>& begin) {
  std::vector<std::uint32_t> order(begin.size() - 1);
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return begin[a + 1] - begin[a] < begin[b + 1] - begin[b];
  });
  return order;
}

}  // namespace

ForestData::ForestData(const CodeSamples& training, bool on_curvature) {
  validate(training);
  if (on_curvature && training.curvature.empty()) {
    throw settings::InputError(
        "a forest on curvature needs the curvature of each training reading, but has none");
  }
  curvatures = on_curvature ? distinct(training.curvature) : std::vector<double>{0.0};
  const FixedPressure mean = meanOf(training.pressure);
  const int dropped = bitsTooMany(training.pressure, mean);
  centre = fromFixed(mean);
  unit = std::ldexp(kFixedPressureUnit, dropped);

  const std::vector<Reading> readings = sorted(training, curvatures);
  std::vector<std::size_t> begin;  // of each entry, in `readings`
  for (std::size_t i = 0; i < readings.size(); ++i) {
    const Reading& reading = readings[i];
    if (i > 0 && code.back() == reading.code && curvature.back() == reading.curvature) continue;
    begin.push_back(i);
    code.push_back(reading.code);
    curvature.push_back(reading.curvature);
  }
  begin.push_back(readings.size());

  const std::vector<std::uint32_t> order = bySize(begin);
  const auto size = [&](std::size_t s) { return begin[order[s] + 1] - begin[order[s]]; };
  slot.resize(entries());
  pressure.reserve(readings.size());
  for (std::size_t first = 0, last = 0; first < order.size(); first = last) {
    for (; last < order.size() && size(last) == size(first); ++last) {
      slot[order[last]] = static_cast<std::uint32_t>(last);
    }
    classes.push_back({last - first, size(first)});
    for (std::size_t reading = 0; reading < size(first); ++reading) {
      for (std::size_t s = first; s < last; ++s) {
        const FixedPressure excess = readings[begin[order[s]] + reading].pressure - mean;
        pressure.push_back(static_cast<double>(excess >> dropped));
      }
    }
  }
}

}  // namespace fsr::regression
