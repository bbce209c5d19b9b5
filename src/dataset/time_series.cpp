#include "dataset/time_series.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "statistics/samples.h"

namespace fsr::dataset {

namespace {

// Monotone cubic interpolation: F. N. Fritsch, R. E. Carlson, SIAM J. Numer. Anal. 17 (1980) 238-246,
// doi:10.1137/0717021. The slope at a value between two intervals: F. N. Fritsch, J. Butland, SIAM J. Sci.
// Stat. Comput. 5 (1984) 300-304, doi:10.1137/0905021. The slope at an end: C. Moler, Numerical Computing
// with Matlab, SIAM 2004, section 3.6. Boost.Math contains pchip only from release 1.74 on.
class MonotoneCubic {
 public:
  MonotoneCubic(const std::vector<std::pair<std::int64_t, double>>& values, std::int64_t longest_gap_ns)
      : values_(values), longest_gap_ns_(longest_gap_ns) {}

  // `low`: the last value before the stamp.
  double operator()(std::size_t low, std::int64_t stamp_ns) const {
    const Chord chord = chordAfter(low);
    const double rise = chord.slope * chord.length;
    const double first = chord.length * slopeAtStartOf(low), last = chord.length * slopeAtEndOf(low);
    const double share = 1e-9 * static_cast<double>(stamp_ns - values_[low].first) / chord.length;
    const double curved = 3 * rise - 2 * first - last + share * (first + last - 2 * rise);
    return values_[low].second + share * (first + share * curved);
  }

 private:
  struct Chord {
    double length;  // [s]
    double slope;
  };

  // Whether the value after `low` is there and no gap lies before it.
  bool joined(std::size_t low) const {
    return low + 1 < values_.size() && values_[low + 1].first - values_[low].first <= longest_gap_ns_;
  }

  Chord chordAfter(std::size_t low) const {
    const double length = 1e-9 * static_cast<double>(values_[low + 1].first - values_[low].first);
    return {length, (values_[low + 1].second - values_[low].second) / length};
  }

  double slopeAtStartOf(std::size_t low) const {
    if (low > 0 && joined(low - 1)) return between(chordAfter(low - 1), chordAfter(low));
    return joined(low + 1) ? atEnd(chordAfter(low), chordAfter(low + 1)) : chordAfter(low).slope;
  }

  double slopeAtEndOf(std::size_t low) const {
    if (joined(low + 1)) return between(chordAfter(low), chordAfter(low + 1));
    return low > 0 && joined(low - 1) ? atEnd(chordAfter(low), chordAfter(low - 1)) : chordAfter(low).slope;
  }

  static double between(const Chord& before, const Chord& after) {
    if (!(before.slope * after.slope > 0)) return 0;
    const double weight_before = before.length + 2 * after.length;
    const double weight_after = 2 * before.length + after.length;
    return (weight_before + weight_after) / (weight_before / before.slope + weight_after / after.slope);
  }

  // `inner`: the interval at whose end the slope is taken, `next`: its neighbour.
  static double atEnd(const Chord& inner, const Chord& next) {
    const double slope = ((2 * inner.length + next.length) * inner.slope - inner.length * next.slope) /
                         (inner.length + next.length);
    if (!(slope * inner.slope > 0)) return 0;
    const bool turns = !(inner.slope * next.slope > 0);
    return turns && std::abs(slope) > 3 * std::abs(inner.slope) ? 3 * inner.slope : slope;
  }

  const std::vector<std::pair<std::int64_t, double>>& values_;
  std::int64_t longest_gap_ns_;
};

}  // namespace

void TimeSeries::add(std::int64_t stamp_ns, double value) {
  if (std::isfinite(value)) {
    values_.emplace_back(stamp_ns, value);
  } else {
    ++not_finite_;
  }
}

void TimeSeries::clear() {
  *this = TimeSeries();
}

void TimeSeries::sort() {
  std::sort(values_.begin(), values_.end());
  const auto same_stamp = [](const Entry& a, const Entry& b) { return a.first == b.first; };
  values_.erase(std::unique(values_.begin(), values_.end(), same_stamp), values_.end());
}

void TimeSeries::drop(const std::vector<std::size_t>& indices) {
  for (auto index = indices.rbegin(); index != indices.rend(); ++index)
    values_.erase(values_.begin() + static_cast<std::ptrdiff_t>(*index));
}

double TimeSeries::interval() const {
  std::vector<double> seconds;
  for (std::size_t i = 1; i < values_.size(); ++i)
    seconds.push_back(1e-9 * static_cast<double>(values_[i].first - values_[i - 1].first));
  return statistics::upperMedian(seconds, 0);
}

template <typename Rule>
std::optional<double> TimeSeries::interpolated(std::int64_t stamp_ns, std::int64_t longest_gap_ns,
                                               Rule rule) const {
  const auto before = [](const Entry& entry, std::int64_t stamp) { return entry.first < stamp; };
  const auto after = std::lower_bound(values_.begin(), values_.end(), stamp_ns, before);
  if (after == values_.end()) return std::nullopt;
  if (after->first == stamp_ns) return after->second;
  if (after == values_.begin()) return std::nullopt;
  const Entry& low = *(after - 1);
  if (after->first - low.first > longest_gap_ns) return std::nullopt;
  const double value = rule(static_cast<std::size_t>(after - values_.begin()) - 1);
  const auto [least, greatest] = std::minmax(low.second, after->second);
  return std::clamp(value, least, greatest);  // rounding may leave it
}

std::optional<double> TimeSeries::between(std::int64_t stamp_ns, std::int64_t longest_gap_ns) const {
  const MonotoneCubic cubic(values_, longest_gap_ns);
  return interpolated(stamp_ns, longest_gap_ns, [&](std::size_t low) { return cubic(low, stamp_ns); });
}

std::optional<double> TimeSeries::straight(std::int64_t stamp_ns, std::int64_t longest_gap_ns) const {
  return interpolated(stamp_ns, longest_gap_ns, [&](std::size_t low) {
    const Entry& from = values_[low];
    const Entry& to = values_[low + 1];
    const double share =
        static_cast<double>(stamp_ns - from.first) / static_cast<double>(to.first - from.first);
    return from.second + share * (to.second - from.second);
  });
}

double TimeSeries::nearby(std::int64_t stamp_ns) const {
  if (stamp_ns <= values_.front().first) return values_.front().second;
  if (stamp_ns >= values_.back().first) return values_.back().second;
  return *between(stamp_ns, std::numeric_limits<std::int64_t>::max());
}

}  // namespace fsr::dataset
