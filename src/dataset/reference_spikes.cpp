#include "dataset/reference_spikes.h"

#include <algorithm>
#include <cmath>

namespace fsr::dataset {

namespace {

constexpr std::size_t kLeastReadings = 20;
constexpr double kFollows = 0.5;    // correlation of reading and pressure
constexpr double kComesBack = 0.5;  // of the jump: the pressure may differ from that before by a ramp
constexpr double kRare = 0.02;      // share of readings beyond each end of the usual range

// Range of the values without the rarest ones, which may be spikes. NaN are left out.
double usualRange(std::vector<double> values) {
  const auto nan = [](double value) { return std::isnan(value); };
  values.erase(std::remove_if(values.begin(), values.end(), nan), values.end());
  if (values.size() < kLeastReadings) return 0;
  std::sort(values.begin(), values.end());
  const auto rare = static_cast<std::size_t>(kRare * static_cast<double>(values.size()));
  return values[values.size() - 1 - rare] - values[rare];
}

// Whether the reading goes with the pressure at all. Pressures beyond the middle of their range count as at
// its ends: spikes have little weight.
bool followsPressure(const std::vector<double>& pressure, const std::vector<double>& reading) {
  std::vector<double> sorted = pressure;
  std::sort(sorted.begin(), sorted.end());
  const auto rare = static_cast<std::size_t>(kRare * static_cast<double>(sorted.size()));
  const double low = sorted[rare], high = sorted[sorted.size() - 1 - rare];
  double n = 0, p = 0, r = 0, pp = 0, rr = 0, pr = 0;
  for (std::size_t i = 0; i < pressure.size(); ++i) {
    if (std::isnan(reading[i])) continue;
    const double x = std::clamp(pressure[i], low, high) - low, y = reading[i];
    n += 1, p += x, r += y, pp += x * x, rr += y * y, pr += x * y;
  }
  const double both = (pp - p * p / n) * (rr - r * r / n);
  return both > 0 && (pr - p * r / n) / std::sqrt(both) >= kFollows;
}

// For each value but the first: +1 or -1 where the pressure jumps up or down and the reading stays, else 0.
std::vector<int> unfeltJumps(const std::vector<double>& pressure, const std::vector<double>& reading,
                             const ReferenceSpikeOptions& options) {
  std::vector<int> jumps(pressure.size(), 0);
  const double range = usualRange(pressure), span = usualRange(reading);
  if (!(range > 0) || !(span > 0)) return jumps;
  for (std::size_t i = 1; i < pressure.size(); ++i) {
    const double jump = (pressure[i] - pressure[i - 1]) / range;
    const double felt = (reading[i] - reading[i - 1]) / span;  // NaN where there is no reading
    if (std::abs(jump) < options.least || std::isnan(felt)) continue;
    if (felt / jump < options.follows) jumps[i] = jump > 0 ? 1 : -1;
  }
  return jumps;
}

}  // namespace

std::vector<std::size_t> referenceSpikes(const std::vector<double>& time, const std::vector<double>& pressure,
                                         const std::vector<double>& reading,
                                         const ReferenceSpikeOptions& options) {
  std::vector<std::size_t> spikes;
  if (pressure.size() < kLeastReadings || !followsPressure(pressure, reading)) return spikes;
  const std::vector<int> jumps = unfeltJumps(pressure, reading, options);
  for (std::size_t first = 1; first < pressure.size(); ++first) {
    if (jumps[first] == 0) continue;
    std::size_t back = first + 1;
    const auto lasts = [&] { return back < pressure.size() && time[back] - time[first] <= options.longest; };
    while (lasts() && jumps[back] != -jumps[first]) ++back;
    if (!lasts()) continue;
    const double away = std::abs(pressure[first] - pressure[first - 1]);
    if (std::abs(pressure[back] - pressure[first - 1]) > kComesBack * away) continue;
    for (std::size_t i = first; i < back; ++i) spikes.push_back(i);
    first = back;
  }
  const double most = options.most * static_cast<double>(pressure.size());
  if (static_cast<double>(spikes.size()) > most) spikes.clear();
  return spikes;
}

}  // namespace fsr::dataset
