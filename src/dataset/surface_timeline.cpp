#include "dataset/surface_timeline.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace fsr::dataset {

namespace {

bool sameSurface(const matrix::Surface& a, const matrix::Surface& b, double tolerance) {
  if (a.name != b.name || a.mount != b.mount || a.known() != b.known()) return false;
  const std::size_t values = std::max(a.curvature.size(), b.curvature.size());
  for (std::size_t i = 0; i < values; ++i) {
    const matrix::Curvature& left = a.at(matrix::TaxelIndex{i});
    const matrix::Curvature& right = b.at(matrix::TaxelIndex{i});
    const double difference =
        std::max({std::abs(left.x - right.x), std::abs(left.y - right.y), std::abs(left.xy - right.xy)});
    if (!(difference < tolerance)) return false;
  }
  return true;
}

// A total order, so that the order of the calls does not matter for two surfaces with the same stamp.
bool beganBefore(const SurfaceTimeline::Event& a, const SurfaceTimeline::Event& b) {
  const auto key = [](const SurfaceTimeline::Event& event) {
    return std::tie(event.first, event.second.name, event.second.mount);
  };
  if (key(a) != key(b)) return key(a) < key(b);
  return std::lexicographical_compare(
      a.second.curvature.begin(), a.second.curvature.end(), b.second.curvature.begin(),
      b.second.curvature.end(), [](const matrix::Curvature& left, const matrix::Curvature& right) {
        return std::tie(left.x, left.y, left.xy) < std::tie(right.x, right.y, right.xy);
      });
}

}  // namespace

SurfaceTimeline::SurfaceTimeline(std::vector<Event> events, double tolerance) {
  const auto known = [](const Event& event) { return event.second.known(); };
  if (std::none_of(events.begin(), events.end(), known)) {
    events.assign(1, Event{std::numeric_limits<std::int64_t>::min(), matrix::Surface{}});
  }
  std::sort(events.begin(), events.end(), beganBefore);
  for (const auto& [stamp, surface] : events) {
    const std::size_t condition = conditionOf(surface, tolerance);
    if (from_.empty() || from_.back().second != condition) from_.emplace_back(stamp, condition);
  }
}

std::size_t SurfaceTimeline::conditionOf(const matrix::Surface& surface, double tolerance) {
  const auto same = [&](const matrix::Surface& other) { return sameSurface(other, surface, tolerance); };
  const auto found = std::find_if(conditions_.begin(), conditions_.end(), same);
  if (found != conditions_.end()) return static_cast<std::size_t>(found - conditions_.begin());
  conditions_.push_back(surface);
  return conditions_.size() - 1;
}

std::vector<SurfaceTimeline::Entry>::const_iterator SurfaceTimeline::after(std::int64_t stamp_ns) const {
  return std::upper_bound(from_.begin(), from_.end(), stamp_ns,
                          [](std::int64_t stamp, const Entry& entry) { return stamp < entry.first; });
}

std::size_t SurfaceTimeline::at(std::int64_t stamp_ns) const {
  const auto next = after(stamp_ns);
  return next == from_.begin() ? next->second : (next - 1)->second;
}

bool SurfaceTimeline::nearChange(std::int64_t stamp_ns, std::int64_t margin_ns) const {
  const auto first_change = from_.begin() + 1;  // the begin of the first surface is no change
  const auto next = std::max(after(stamp_ns), first_change);
  const bool soon = next != from_.end() && next->first - stamp_ns <= margin_ns;
  const bool just = next != first_change && stamp_ns - (next - 1)->first <= margin_ns;
  return soon || just;
}

}  // namespace fsr::dataset
