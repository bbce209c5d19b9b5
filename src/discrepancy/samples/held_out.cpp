#include "discrepancy/samples/held_out.h"

#include <algorithm>
#include <cmath>

#include "settings/number_text.h"
#include "statistics/median.h"

#include "discrepancy/thresholds.h"

namespace fsr::discrepancy {

namespace {

// A feature that jumps by more than this factor starts a new group of cycles.
constexpr double kOtherSpeed = 1.5;
constexpr double kOtherDwell = 3;
constexpr double kOtherPeak = 1.3;

constexpr double kStill = 0.05;    // share of the fastest rate; below it the chamber holds its pressure
constexpr double kLeastDwell = 2;  // shorter dwells count as corners [s]

// The protocol of one cycle.
struct Course {
  double speed = 0;  // median speed of the ramps [Pa/s]
  double dwell = 0;  // time at constant pressure under load, at least kLeastDwell [s]
  double peak = 0;   // [Pa]
};

Course courseOf(const Measured& measured, const MeasuredCycle& cycle, double fastest, double highest) {
  Course course;
  std::vector<double> speeds;
  for (std::size_t i = cycle.first; i < cycle.last; ++i) {
    course.peak = std::max(course.peak, measured.pressure[i]);
    const double speed = std::abs(measured.rate[i]);
    if (speed > kStill * fastest) speeds.push_back(speed);
    const bool holds = speed <= kStill * fastest && measured.pressure[i] > thresholds::kLoaded * highest;
    if (holds && i + 1 < cycle.last) course.dwell += measured.time[i + 1] - measured.time[i];
  }
  course.speed = statistics::upperMedian(speeds, 0);
  course.dwell = std::max(course.dwell, kLeastDwell);
  return course;
}

// Sorts the cycles by one feature and divides them into groups where the feature jumps by more than `factor`.
std::vector<std::vector<std::size_t>> groupsBy(const std::vector<double>& feature, double factor) {
  std::vector<std::size_t> order;
  for (std::size_t c = 0; c < feature.size(); ++c) {
    if (feature[c] > 0) order.push_back(c);
  }
  std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return feature[a] < feature[b]; });
  std::vector<std::vector<std::size_t>> groups;
  for (std::size_t k = 0; k < order.size(); ++k) {
    const bool jumps = k > 0 && feature[order[k]] > factor * feature[order[k - 1]];
    if (k == 0 || jumps) groups.emplace_back();
    groups.back().push_back(order[k]);
  }
  for (auto& group : groups) std::sort(group.begin(), group.end());
  return groups;
}

bool anyHeldOut(const Measured& measured, const std::vector<std::size_t>& cycles) {
  return std::any_of(cycles.begin(), cycles.end(),
                     [&](std::size_t c) { return measured.cycles[c].use == CycleUse::kHoldOut; });
}

// One part for each group of cycles that contains hold-out cycles. With fewer than two such groups there are
// no parts: all cycles count as alike.
std::vector<Part> partsBy(const Measured& measured, const std::vector<double>& feature, double factor,
                          const char* before, const char* after, double unit) {
  std::vector<Part> parts;
  for (const auto& group : groupsBy(feature, factor)) {
    std::vector<double> members;
    for (const std::size_t c : group) members.push_back(feature[c] / unit);
    if (anyHeldOut(measured, group))
      parts.push_back(
          {before + settings::roundedText(statistics::upperMedian(members, 0), 2) + after, group});
  }
  return parts.size() < 2 ? std::vector<Part>() : parts;
}

}  // namespace

std::vector<Part> partsByCondition(const Measured& measured) {
  std::vector<Part> parts;
  for (const dataset::CurvatureClass& c : measured.classes) parts.push_back({c.surface, {}});
  for (std::size_t c = 0; c < measured.cycles.size(); ++c) {
    parts[measured.visits[measured.cycles[c].visit].curvature_class].cycles.push_back(c);
  }
  const auto holds_nothing_out = [&](const Part& part) { return !anyHeldOut(measured, part.cycles); };
  parts.erase(std::remove_if(parts.begin(), parts.end(), holds_nothing_out), parts.end());
  return parts.size() < 2 ? std::vector<Part>() : parts;
}

std::vector<Part> partsByProtocol(const Measured& measured) {
  const double highest = *std::max_element(measured.pressure.begin(), measured.pressure.end());
  double fastest = 0;
  for (const double rate : measured.rate) fastest = std::max(fastest, std::abs(rate));
  std::vector<double> speed, dwell, peak;
  for (const MeasuredCycle& cycle : measured.cycles) {
    const Course course = courseOf(measured, cycle, fastest, highest);
    speed.push_back(course.speed);
    dwell.push_back(course.dwell);
    peak.push_back(course.peak);
  }
  std::vector<Part> parts = partsBy(measured, speed, kOtherSpeed, "ramps of ", " kPa/s", 1e3);
  if (parts.empty()) parts = partsBy(measured, dwell, kOtherDwell, "dwells of ", " s", 1);
  if (parts.empty()) parts = partsBy(measured, peak, kOtherPeak, "peaks of ", " kPa", 1e3);
  return parts;
}

Measured withoutPart(const Measured& measured, const Part& part) {
  Measured rest = measured;
  for (const std::size_t c : part.cycles) rest.cycles[c].use = CycleUse::kHoldOut;
  return rest;
}

}  // namespace fsr::discrepancy
