#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace fsr::dataset {

/// A measured quantity at stamps [ns]. Values that are not finite are no measurement: they are
/// counted and left out. Of several values at one stamp the smallest is kept, so that the series
/// does not depend on the order of the calls.
class TimeSeries {
 public:
  void add(std::int64_t stamp_ns, double value);
  void clear();
  /// Must be called after the last add() and before a value is asked for.
  void sort();

  bool empty() const { return values_.empty(); }
  std::size_t size() const { return values_.size(); }
  std::uint64_t notFinite() const { return not_finite_; }

  /// The value at `stamp_ns`, interpolated linearly between the neighbours; none where no two
  /// values within `longest_gap_ns` of each other bracket it.
  std::optional<double> between(std::int64_t stamp_ns, std::int64_t longest_gap_ns) const;
  /// Likewise over gaps of any length; before the first and after the last value theirs. The series
  /// must not be empty.
  double nearby(std::int64_t stamp_ns) const;

 private:
  using Entry = std::pair<std::int64_t, double>;
  std::vector<Entry> values_;
  std::uint64_t not_finite_ = 0;
};

}  // namespace fsr::dataset
