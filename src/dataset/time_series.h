#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace fsr::dataset {

/// A measured quantity at stamps [ns]. Values that are not finite are counted and left out. Of several values
/// at the same stamp the smallest is kept, so that the series does not depend on the order of the calls.
class TimeSeries {
 public:
  using Entry = std::pair<std::int64_t, double>;  // stamp [ns], value

  void add(std::int64_t stamp_ns, double value);
  void clear();
  /// Call it after the last add() and before reading values.
  void sort();

  bool empty() const { return values_.empty(); }
  std::size_t size() const { return values_.size(); }
  std::uint64_t notFinite() const { return not_finite_; }
  const std::vector<Entry>& entries() const { return values_; }
  /// Median time between two values [s]; 0 for fewer than two.
  double interval() const;
  /// Removes the entries at these indices, which ascend.
  void drop(const std::vector<std::size_t>& indices);

  /// The value at `stamp_ns`, by monotone cubic interpolation (PCHIP): the curve passes through all values,
  /// and between two of them it stays in their range. None where the value before or after is missing, or
  /// where they are more than `longest_gap_ns` apart. Values on the other side of such a gap have no
  /// influence.
  std::optional<double> between(std::int64_t stamp_ns, std::int64_t longest_gap_ns) const;
  /// The same by linear interpolation.
  std::optional<double> straight(std::int64_t stamp_ns, std::int64_t longest_gap_ns) const;
  /// As between(), over gaps of any length. Before the first value it is the first, after the last the last
  /// one. The series must not be empty.
  double nearby(std::int64_t stamp_ns) const;

 private:
  // `rule`: the value at the stamp, by the index of the last value before it.
  template <typename Rule>
  std::optional<double> interpolated(std::int64_t stamp_ns, std::int64_t longest_gap_ns, Rule rule) const;

  std::vector<Entry> values_;
  std::uint64_t not_finite_ = 0;
};

}  // namespace fsr::dataset
