#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "fsr_pressure_map/matrix/curvature.h"

namespace fsr::dataset {

/// The surfaces of a matrix over time. A surface is valid from its stamp to the next one's. The first is
/// valid before its stamp too, because surfaces are repeated each second. The result does not depend on the
/// order of the events.
class SurfaceTimeline {
 public:
  using Event = std::pair<std::int64_t, matrix::Surface>;  ///< stamp [ns]

  /// Surfaces of the same name and mount whose curvatures differ by less than `tolerance` [1/m] at every
  /// taxel are one condition. Where no curvature is known, there is one condition of unknown curvature and no
  /// change.
  SurfaceTimeline(std::vector<Event> events, double tolerance);

  /// In the order of their first appearance.
  const std::vector<matrix::Surface>& conditions() const { return conditions_; }
  bool anyKnown() const { return conditions_.size() > 1 || conditions_.front().known(); }
  /// Index of the condition that is valid at a stamp.
  std::size_t at(std::int64_t stamp_ns) const;
  /// Whether the surface changes within `margin_ns` [ns] before or after the stamp.
  bool nearChange(std::int64_t stamp_ns, std::int64_t margin_ns) const;

 private:
  using Entry = std::pair<std::int64_t, std::size_t>;

  std::size_t conditionOf(const matrix::Surface& surface, double tolerance);
  std::vector<Entry>::const_iterator after(std::int64_t stamp_ns) const;

  std::vector<matrix::Surface> conditions_;
  std::vector<Entry> from_;  // where each condition begins; never empty
};

}  // namespace fsr::dataset
