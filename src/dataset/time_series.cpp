#include "dataset/time_series.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fsr::dataset {

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

std::optional<double> TimeSeries::between(std::int64_t stamp_ns, std::int64_t longest_gap_ns) const {
  const auto before = [](const Entry& entry, std::int64_t stamp) { return entry.first < stamp; };
  const auto after = std::lower_bound(values_.begin(), values_.end(), stamp_ns, before);
  if (after == values_.end()) return std::nullopt;
  if (after->first == stamp_ns) return after->second;
  if (after == values_.begin()) return std::nullopt;
  const Entry& low = *(after - 1);
  const std::int64_t gap = after->first - low.first;
  if (gap > longest_gap_ns) return std::nullopt;
  const double share = static_cast<double>(stamp_ns - low.first) / static_cast<double>(gap);
  return low.second + share * (after->second - low.second);
}

double TimeSeries::nearby(std::int64_t stamp_ns) const {
  if (stamp_ns <= values_.front().first) return values_.front().second;
  if (stamp_ns >= values_.back().first) return values_.back().second;
  return *between(stamp_ns, std::numeric_limits<std::int64_t>::max());
}

}  // namespace fsr::dataset
