#include "dataset/pressure_rate.h"

#include <algorithm>
#include <cmath>

namespace fsr::dataset {

namespace {

constexpr double kRateWindow = 2;  // over which the rate of pressure is found [s]

}  // namespace

std::vector<double> pressureRates(const Recording& recording) {
  const std::size_t n = recording.scans();
  std::vector<double> rate(n, 0);
  std::size_t first = 0, last = 0;
  double count = 0, t = 0, p = 0, tt = 0, tp = 0;
  const auto add = [&](std::size_t i, double weight) {
    // Relative to the first scan, so that the sums keep their digits.
    const double time = recording.time[i] - recording.time[0];
    count += weight, t += weight * time, p += weight * recording.pressure[i];
    tt += weight * time * time, tp += weight * time * recording.pressure[i];
  };
  for (std::size_t i = 0; i < n; ++i) {
    if (i == 0 || recording.condition[i] != recording.condition[i - 1]) {
      first = last = i;
      count = t = p = tt = tp = 0;
    }
    while (last < n && recording.condition[last] == recording.condition[i] &&
           recording.time[last] <= recording.time[i] + kRateWindow / 2) {
      add(last++, 1);
    }
    while (recording.time[first] < recording.time[i] - kRateWindow / 2) add(first++, -1);
    const double spread = tt - t * t / count;
    rate[i] = spread > 1e-9 ? (tp - t * p / count) / spread : 0;
  }
  return rate;
}

std::vector<std::uint8_t> dwellsOf(const Recording& recording) {
  std::vector<std::uint8_t> dwells(recording.scans(), 0);
  const auto finite = [](double pressure) { return std::isfinite(pressure); };
  if (!std::all_of(recording.pressure.begin(), recording.pressure.end(), finite)) return dwells;
  const std::vector<double> rate = pressureRates(recording);
  double fastest = 0, highest = 0;
  for (std::size_t i = 0; i < rate.size(); ++i) {
    fastest = std::max(fastest, std::abs(rate[i]));
    highest = std::max(highest, recording.pressure[i]);
  }
  const auto holds = [&](std::size_t i) {
    return std::abs(rate[i]) <= kStill * fastest && recording.pressure[i] > kLoaded * highest;
  };
  for (std::size_t first = 0; first < rate.size(); ++first) {
    if (!holds(first)) continue;
    std::size_t last = first;
    while (last + 1 < rate.size() && recording.condition[last + 1] == recording.condition[first] &&
           holds(last + 1)) {
      ++last;
    }
    if (recording.time[last] - recording.time[first] >= kLeastDwell)
      std::fill(dwells.begin() + std::ptrdiff_t(first), dwells.begin() + std::ptrdiff_t(last) + 1, 1);
    first = last;
  }
  return dwells;
}

}  // namespace fsr::dataset
