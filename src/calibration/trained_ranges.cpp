#include "calibration/trained_ranges.h"

#include <cmath>

namespace fsr::calibration {

namespace {

// Over a shorter time, noise would count as a rate; over a longer one, a gap would hide it [s].
constexpr double kRateSpan = 1.0;
constexpr double kLongestRateSpan = 2.0;

// The rate of the pressure from scan `i` over kRateSpan. `later` moves along with i. NaN if the condition
// changes or the scans pause in between.
double rateFrom(const dataset::Recording& recording, std::size_t i, std::size_t& later) {
  while (later < recording.scans() && recording.time[later] - recording.time[i] < kRateSpan) ++later;
  if (later == recording.scans() || recording.condition[later] != recording.condition[i]) return NAN;
  const double span = recording.time[later] - recording.time[i];
  if (span > kLongestRateSpan) return NAN;
  return (recording.pressure[later] - recording.pressure[i]) / span;
}

}  // namespace

void TrainedInterval::include(double value) {
  if (std::isnan(value)) return;
  if (!(low <= value)) low = value;
  if (!(high >= value)) high = value;
}

TrainedRanges findTrainedRanges(const std::vector<dataset::Recording>& recordings,
                                const dataset::ConditionClasses& classes, const std::vector<bool>& trained) {
  TrainedRanges ranges;
  for (std::size_t r = 0; r < recordings.size(); ++r) {
    const dataset::Recording& recording = recordings[r];
    std::size_t later = 0;
    for (std::size_t i = 0; i < recording.scans(); ++i) {
      if (!trained[classes.class_of[r][recording.condition[i]]]) continue;
      ranges.pressure.include(recording.pressure[i]);
      ranges.pressure_rate.include(rateFrom(recording, i, later));
      if (!recording.temperature.empty()) ranges.temperature.include(recording.temperature[i]);
    }
  }
  for (std::size_t c = 0; c < classes.classes.size(); ++c) {
    if (!trained[c]) continue;
    for (const double curvature : classes.classes[c].curvature) ranges.curvature.include(curvature);
  }
  return ranges;
}

}  // namespace fsr::calibration
