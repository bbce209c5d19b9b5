#include "discrepancy/samples/views.h"

#include <algorithm>
#include <cmath>

#include "dataset/protocols.h"
#include "dataset/sections.h"
#include "settings/number_text.h"
#include "statistics/samples.h"

namespace fsr::discrepancy {

namespace {

constexpr std::size_t kRarely = 2000;  // one scan in so many: a pressure that counts as not covered
constexpr std::int64_t kRounding = 2;  // of times that are kept in seconds [ns]

std::int64_t stampOf(const dataset::Recording& recording, std::size_t scan) {
  return recording.start_ns + std::llround(recording.time[scan] * 1e9);
}

// Sample of each scan of the recordings that were admitted, kNotInView for cycles of another use.
std::vector<std::vector<std::uint32_t>> samplesOf(const Measured& measured, CycleUse use) {
  std::vector<std::vector<std::uint32_t>> samples;
  for (const dataset::Recording& recording : *measured.recordings)
    samples.emplace_back(recording.scans(), ScanView::kNotInView);
  for (std::size_t m = 0; m < measured.samples(); ++m) {
    if (measured.cycles[measured.cycle[m]].use != use) continue;
    auto& of_recording = samples[measured.visits[measured.visit[m]].recording];
    const auto first = of_recording.begin() + static_cast<std::ptrdiff_t>(measured.first_scan[m]);
    std::fill(first, first + measured.scans[m], static_cast<std::uint32_t>(m));
  }
  return samples;
}

// The samples of the scans of `whole`, which has all scans of `admitted` and more.
std::vector<std::uint32_t> onto(const dataset::Recording& whole, const dataset::Recording& admitted,
                                const std::vector<std::uint32_t>& samples) {
  std::vector<std::uint32_t> result(whole.scans(), ScanView::kNotInView);
  std::size_t next = 0;
  for (std::size_t i = 0; i < whole.scans() && next < samples.size(); ++i) {
    if (std::abs(stampOf(whole, i) - stampOf(admitted, next)) > kRounding) continue;
    result[i] = samples[next++];
  }
  return result;
}

}  // namespace

ScanView::ScanView(const Measured& measured, CycleUse use) : measured_(measured) {
  const std::vector<dataset::Recording>& admitted = *measured.recordings;
  const std::vector<dataset::Recording>& whole = measured.whole ? *measured.whole : admitted;
  std::vector<std::vector<std::uint32_t>> samples = samplesOf(measured, use);
  for (const std::size_t r : dataset::inOrderOfTime(admitted)) {
    order_.push_back(&whole[r]);
    sample_.push_back(measured.whole ? onto(whole[r], admitted[r], samples[r]) : std::move(samples[r]));
    unmasked_.emplace_back(measured.taxels(), 1);
    for (std::size_t t = 0; t < admitted[r].mask.size(); ++t) unmasked_.back()[t] = admitted[r].mask[t] == 0;
  }
}

std::size_t ScanView::scans() const {
  std::size_t number = 0;
  for (const auto& samples : sample_)
    number +=
        samples.size() - static_cast<std::size_t>(std::count(samples.begin(), samples.end(), kNotInView));
  return number;
}

FitView::FitView(const Measured& measured) : ScanView(measured, CycleUse::kFit) {
  std::vector<std::vector<double>> pressures(classes());
  for (std::size_t r = 0; r < order_.size(); ++r) {
    for (std::size_t i = 0; i < sample_[r].size(); ++i) {
      if (sample_[r][i] != kNotInView) pressures[classOf(sample_[r][i])].push_back(order_[r]->pressure[i]);
    }
  }
  for (std::vector<double>& of_class : pressures) {
    std::sort(of_class.begin(), of_class.end());
    const std::size_t rare = of_class.size() / kRarely;
    covered_.push_back(of_class.empty() ? Interval{INFINITY, -INFINITY}
                                        : Interval{of_class[rare], of_class[of_class.size() - 1 - rare]});
  }
  for (std::size_t r = 0; r < order_.size(); ++r) {
    for (std::size_t i = 0; i < sample_[r].size(); ++i) {
      if (sample_[r][i] == kNotInView) continue;
      const Interval& range = covered_[classOf(sample_[r][i])];
      const double pressure = order_[r]->pressure[i];
      if (pressure < range.low || pressure > range.high) sample_[r][i] = kNotInView;
    }
  }
}

HoldOutView::HoldOutView(const Measured& measured, const FitView& fit)
    : ScanView(measured, CycleUse::kHoldOut) {
  for (std::size_t r = 0; r < order_.size(); ++r) {
    for (std::size_t i = 0; i < sample_[r].size(); ++i) {
      if (sample_[r][i] == kNotInView) continue;
      const Interval& range = fit.covered(classOf(sample_[r][i]));
      const double pressure = order_[r]->pressure[i];
      if (pressure >= range.low && pressure <= range.high) continue;
      sample_[r][i] = kNotInView;
      ++left_out_;
    }
  }
}

std::vector<HoldOutCycles> HoldOutView::spans() const {
  std::vector<HoldOutCycles> bags;
  for (std::size_t r = 0; r < order_.size(); ++r) {
    HoldOutCycles bag{order_[r]->name, {}};
    std::uint32_t last = kNotInView;  // sample of the scan before
    for (std::size_t i = 0; i < sample_[r].size(); ++i) {
      const std::uint32_t sample = sample_[r][i];
      if (sample != kNotInView) {
        const std::int64_t stamp = stampOf(*order_[r], i);
        const bool goes_on = last != kNotInView && cycleOf(sample) == cycleOf(last);
        if (!goes_on) bag.cycles.emplace_back(stamp, stamp);
        bag.cycles.back().second = stamp;
      }
      last = sample;
    }
    if (!bag.cycles.empty()) bags.push_back(std::move(bag));
  }
  return bags;
}

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
