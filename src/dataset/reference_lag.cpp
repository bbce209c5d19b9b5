#include "dataset/reference_lag.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "dataset/count_readers.h"
#include "dataset/cycles.h"
#include "statistics/median.h"

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
  const std::vector<double> matrix = rates(evenly(time, reading, step), span);
  const std::vector<double> chamber = rates(evenly(time, pressure, step), span);
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

}  // namespace fsr::dataset
