#include "dataset/reference_errors.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "dataset/count_readers.h"
#include "dataset/sections.h"
#include "statistics/samples.h"

namespace fsr::dataset {

namespace {

constexpr std::size_t kLeastScans = 50;
constexpr double kShortestStep =
    0.05;  // [s]: faster scans are averaged; the pressure of a chamber turns more slowly
constexpr double kLongestSpan = 2.0;   // over which a rate of change is taken [s],
constexpr double kSpanOfCycle = 0.05;  // and how much of a cycle at most (ratio)

std::vector<double> medianReadings(const Recording& recording) {
  std::vector<double> result, values;
  const std::size_t taxels = recording.layout.size.taxels();
  ScanCounts counts(recording);
  for (std::size_t i = 0; i < recording.scans(); ++i) {
    values.clear();
    const std::uint16_t* const scan = counts[i];
    for (std::size_t t = 0; t < taxels; ++t) {
      if (recording.mask.empty() || recording.mask[t] == 0) values.push_back(scan[t]);
    }
    result.push_back(values.empty() ? 0 : statistics::upperMedian(values));
  }
  return result;
}

double usualStep(const std::vector<double>& time) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < time.size(); ++i) steps.push_back(time[i] - time[i - 1]);
  return std::max(statistics::upperMedian(steps), kShortestStep);
}

// Means over each step of an even grid. A step without scans is interpolated between its neighbours.
std::vector<double> evenly(const std::vector<double>& time, const std::vector<double>& values, double step) {
  const auto cells = static_cast<std::size_t>((time.back() - time.front()) / step) + 1;
  std::vector<double> sums(cells, 0.0), counts(cells, 0.0);
  for (std::size_t i = 0; i < time.size(); ++i) {
    const auto cell = std::min(cells - 1, static_cast<std::size_t>((time[i] - time.front()) / step));
    sums[cell] += values[i];
    counts[cell] += 1;
  }
  std::size_t last = 0;  // the first cell holds the first scan
  for (std::size_t c = 0; c < cells; ++c) {
    if (counts[c] == 0) continue;
    sums[c] /= counts[c];
    for (std::size_t k = last + 1; k < c; ++k) {
      sums[k] = sums[last] + (sums[c] - sums[last]) * double(k - last) / double(c - last);
    }
    last = c;
  }
  sums.resize(last + 1);
  return sums;
}

std::vector<double> rates(const std::vector<double>& values, std::size_t span) {
  std::vector<double> result(values.size(), 0.0);
  for (std::size_t i = span; i + span < values.size(); ++i) result[i] = values[i + span] - values[i - span];
  return result;
}

// Half of the span over which rates are taken [steps]: long beside the noise of single readings, short beside
// a cycle.
std::size_t halfSpan(const std::vector<double>& time, const std::vector<double>& pressure, double step) {
  const auto cycles = static_cast<double>(std::max<std::size_t>(1, findCycles(pressure).count()));
  const double cycle = (time.back() - time.front()) / cycles;
  return static_cast<std::size_t>(
      std::max(1.0, std::round(std::min(kLongestSpan, kSpanOfCycle * cycle) / 2 / step)));
}

// What a sheet without any lag reads at each pressure: the reading with the same rank. A curved
// characteristic moves the steepest part of a ramp, which would look like a lag.
std::vector<double> asReadings(const std::vector<double>& pressure, std::vector<double> reading) {
  std::vector<std::size_t> order(pressure.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return pressure[a] < pressure[b]; });
  std::sort(reading.begin(), reading.end());
  std::vector<double> result(pressure.size());
  for (std::size_t k = 0; k < order.size(); ++k) result[order[k]] = reading[k];
  return result;
}

// Correlation of a[i + shift] with b[i], over all i where both exist.
double correlation(const std::vector<double>& a, const std::vector<double>& b, std::ptrdiff_t shift) {
  const auto size = static_cast<std::ptrdiff_t>(b.size());
  double aa = 0, bb = 0, ab = 0;
  for (auto i = std::max<std::ptrdiff_t>(0, -shift); i < std::min(size, size - shift); ++i) {
    const double x = a[static_cast<std::size_t>(i + shift)], y = b[static_cast<std::size_t>(i)];
    aa += x * x;
    bb += y * y;
    ab += x * y;
  }
  return aa > 0 && bb > 0 ? ab / std::sqrt(aa * bb) : 0;
}

}  // namespace

std::optional<ReferenceLag> referenceLag(const Recording& recording, const ReferenceLagOptions& options) {
  if (recording.pressure.size() != recording.scans() || recording.scans() < kLeastScans) return std::nullopt;
  return referenceLag(recording.time, medianReadings(recording), recording.pressure, options);
}

std::optional<ReferenceLag> referenceLag(const std::vector<double>& time, const std::vector<double>& reading,
                                         const std::vector<double>& pressure,
                                         const ReferenceLagOptions& options) {
  if (time.size() < kLeastScans) return std::nullopt;
  const double step = usualStep(time);
  const std::size_t span = halfSpan(time, pressure, step);
  const std::vector<double> readings = evenly(time, reading, step);
  const std::vector<double> matrix = rates(readings, span);
  const std::vector<double> chamber = rates(asReadings(evenly(time, pressure, step), readings), span);
  const auto most = std::min(static_cast<std::ptrdiff_t>(std::ceil(options.longest / step)),
                             static_cast<std::ptrdiff_t>(matrix.size() / 3));
  std::vector<double> fits;
  for (std::ptrdiff_t shift = -most; shift <= most; ++shift) {
    fits.push_back(correlation(matrix, chamber, shift));
  }
  const auto best = std::max_element(fits.begin(), fits.end());
  if (*best < options.least_correlation) return std::nullopt;
  double place = double(best - fits.begin());
  if (best != fits.begin() && best + 1 != fits.end()) {  // the top of the parabola through three
    const double bend = *(best - 1) - 2 * *best + *(best + 1);
    if (bend < 0) place += 0.5 * (*(best - 1) - *(best + 1)) / bend;
  }
  return ReferenceLag{(place - double(most)) * step, *best, step};
}

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
