#include "discrepancy/samples/held_out.h"

#include <algorithm>
#include <cmath>

#include "dataset/protocols.h"
#include "settings/number_text.h"
#include "statistics/median.h"

namespace fsr::discrepancy {

namespace {

bool anyHeldOut(const Measured& measured, const std::vector<std::size_t>& cycles) {
  return std::any_of(cycles.begin(), cycles.end(),
                     [&](std::size_t c) { return measured.cycles[c].use == CycleUse::kHoldOut; });
}

// One part for each group of cycles that contains hold-out cycles. With fewer than two such groups there are
// no parts: all cycles count as alike.
std::vector<Part> partsBy(const Measured& measured, const std::vector<double>& feature, double factor,
                          const char* before, const char* after, double unit) {
  std::vector<Part> parts;
  for (const auto& group : dataset::groupsByJump(feature, factor)) {
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
  dataset::CourseScale scale;
  scale.highest = *std::max_element(measured.pressure.begin(), measured.pressure.end());
  for (const double rate : measured.rate) scale.fastest = std::max(scale.fastest, std::abs(rate));
  std::vector<double> speed, dwell, peak;
  for (const MeasuredCycle& cycle : measured.cycles) {
    const std::size_t first = cycle.first;
    const dataset::CycleCourse course = dataset::courseOf(&measured.time[first], &measured.pressure[first],
                                                          &measured.rate[first], cycle.last - first, scale);
    speed.push_back(course.speed);
    dwell.push_back(course.dwell);
    peak.push_back(course.peak);
  }
  std::vector<Part> parts = partsBy(measured, speed, dataset::kOtherSpeed, "ramps of ", " kPa/s", 1e3);
  if (parts.empty()) parts = partsBy(measured, dwell, dataset::kOtherDwell, "dwells of ", " s", 1);
  if (parts.empty()) parts = partsBy(measured, peak, dataset::kOtherPeak, "peaks of ", " kPa", 1e3);
  return parts;
}

Measured withoutPart(const Measured& measured, const Part& part) {
  Measured rest = measured;
  for (const std::size_t c : part.cycles) rest.cycles[c].use = CycleUse::kHoldOut;
  return rest;
}

}  // namespace fsr::discrepancy
