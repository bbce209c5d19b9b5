#include "check/socket_check.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "calibration/sources.h"
#include "calibration/stages/temperature/temperature_course.h"
#include "check/check.h"
#include "dataset/count_readers.h"
#include "fsr_pressure_map/calibration/calibrator.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "health/recording_health.h"
#include "settings/number_text.h"
#include "statistics/samples.h"

namespace fsr::check {

namespace {

constexpr double kRestTime = 2.0;  // shortest rest before and after [s]
constexpr double kRestShare =
    0.25;  // largest reading at rest, on the way from the lowest one to the usual load
constexpr double kRestChange = 0.02;      // of a taxel from rest before to rest after [share of full scale]
constexpr double kChangedShare = 0.05;    // of taxels that may change by more
constexpr double kSaturatedShare = 0.01;  // of readings at full scale
constexpr double kBeyondShare = 0.05;     // of readings outside of training
constexpr double kContactShare = 0.10;    // a taxel is loaded from this reading on [share of full scale]
constexpr double kStaticRange = 0.20;   // a load is static while it varies by less than this share of itself
constexpr double kStaticLoad = 300;     // longest static load without a remark about creep [s]
constexpr double kAtTheEnds = 0.25;     // share of the recording: rest is searched in its first and last part
constexpr double kFarBelowLoad = 0.5;   // share of the usual load
constexpr double kShortestCell = 0.25;  // loads are averaged over this time: short compared with a step [s],
constexpr double kScansOfCell = 2.5;    // and long compared with the time between scans

using Means = std::vector<statistics::RunningMoments>;  // [taxels]

// Adds the pressures of a map within a rest.
void addTo(Means& means, const std::optional<SocketRest>& rest, const map::PressureMap& map, double time) {
  if (!rest || time < rest->from || time > rest->to) return;
  for (std::size_t t = 0; t < means.size(); ++t) {
    if (!std::isnan(map.pressure[t])) means[t].add(double(map.pressure[t]));
  }
}

class SocketChecker {
 public:
  SocketChecker(const dataset::Recording& recording, const calibration::Calibration* calibration)
      : recording_(recording), calibration_(calibration), counts_(recording) {
    for (std::size_t t = 0; t < taxels(); ++t) {
      if (recording.mask.empty() || recording.mask[t] == 0) used_.push_back(t);
    }
    for (std::size_t i = 0; i < recording.scans(); ++i) mean_.push_back(sheetMean(i));
    rest_limit_ = restLimit();
  }

  SocketCheck run(const DonDoff& events) {
    check_.name = recording_.name;
    check_.layout = recording_.layout;
    findRests(events);
    compareRests();
    const health::RecordingHealth health = health::recordingHealth(recording_);
    check_.saturated = health.saturated;
    check_.dead = health.dead;
    check_.stuck = health.stuck;
    if (calibration_ != nullptr) calibrate();
    findStaticLoad(events);
    judge();
    return check_;
  }

 private:
  std::size_t taxels() const { return recording_.layout.size.taxels(); }
  double share(std::uint16_t count) const { return double(count) / double(recording_.full_scale); }
  double sheetMean(std::size_t scan) {
    double sum = 0;
    const std::uint16_t* const counts = counts_[scan];
    for (const std::size_t t : used_) sum += share(counts[t]);
    return used_.empty() ? 0 : sum / double(used_.size());
  }

  // The reading of the loaded sheet: the median of the scans with more than half of the largest reading.
  double usualLoad() const {
    const double most = *std::max_element(mean_.begin(), mean_.end());
    std::vector<double> loaded;
    std::copy_if(mean_.begin(), mean_.end(), std::back_inserter(loaded),
                 [&](double value) { return value >= 0.5 * most; });
    return statistics::upperMedian(loaded);
  }

  // The largest mean reading of the sheet at rest: a share of the way from the lowest reading to the usual
  // load. A sheet that is bent or has been loaded for long does not return to zero. Without a reading far
  // below the load nothing is known of the rest, and the share is that of the load.
  double restLimit() const {
    const double usual = usualLoad();
    const std::optional<Stretch> lowest = lowestStretch(0, recording_.time.back(), INFINITY);
    const double low = lowest ? lowest->mean : INFINITY;
    const double limit = kRestShare * usual;
    return low <= kFarBelowLoad * usual ? std::max(limit, low + kRestShare * (usual - low)) : limit;
  }

  // Scans [first, end) with the mean reading of the sheet.
  struct Stretch {
    std::size_t first, end;
    double mean;
  };

  // The stretch of rest_time within [from, to] [s] with the lowest reading, `least` at most.
  std::optional<Stretch> lowestStretch(double from, double to, double least) const {
    const std::vector<double>& time = recording_.time;
    std::optional<Stretch> best;
    double sum = 0;
    for (std::size_t first = 0, end = 0; first < time.size(); ++first) {
      while (end < time.size() && (end <= first || time[end - 1] - time[first] < kRestTime)) {
        sum += mean_[end++];
      }
      if (time[end - 1] - time[first] < kRestTime || time[end - 1] > to) break;
      const double mean = sum / double(end - first);
      if (time[first] >= from && mean <= least) {
        least = mean;
        best = Stretch{first, end, mean};
      }
      sum -= mean_[first];
    }
    return best;
  }

  std::optional<SocketRest> restWithin(double from, double to) {
    const std::optional<Stretch> stretch = lowestStretch(from, to, rest_limit_);
    if (!stretch) return std::nullopt;
    const double scans = double(stretch->end - stretch->first);
    SocketRest rest{recording_.time[stretch->first], recording_.time[stretch->end - 1],
                    std::vector<double>(taxels(), 0.0)};
    for (std::size_t i = stretch->first; i < stretch->end; ++i) {
      const std::uint16_t* const counts = counts_[i];
      for (std::size_t t = 0; t < taxels(); ++t) rest.readings[t] += share(counts[t]) / scans;
    }
    return rest;
  }

  void findRests(const DonDoff& events) {
    const double end = recording_.time.back(), part = kAtTheEnds * end;
    check_.before = restWithin(0, events.don.value_or(part));
    check_.after = restWithin(events.doff.value_or(end - part), end);
    // An event that was marked late leaves too little of the rest.
    if (!check_.before) check_.before = restWithin(0, part);
    if (!check_.after) check_.after = restWithin(end - part, end);
  }

  void compareRests() {
    if (!check_.before || !check_.after) return;
    check_.change.assign(taxels(), 0.0);
    std::vector<double> changes;
    check_.worst = used_.empty() ? 0 : used_.front();
    for (const std::size_t t : used_) {
      check_.change[t] = check_.after->readings[t] - check_.before->readings[t];
      changes.push_back(check_.change[t]);
      check_.changed += std::abs(check_.change[t]) > kRestChange;
      if (std::abs(check_.change[t]) > std::abs(check_.change[check_.worst])) check_.worst = t;
    }
    check_.median_change = statistics::upperMedian(changes);
  }

  void calibrate() {
    calibration::requireMatrix(*calibration_, recording_);
    calibration::Calibrator calibrator(*calibration_);
    calibrator.setMask(recording_.mask);
    std::size_t surface = recording_.conditions.size(), readings = 0, beyond = 0, bent = 0;
    map::PressureMap map;
    Means before(taxels()), after(taxels());
    for (std::size_t i = 0; i < recording_.scans(); ++i) {
      const double time = recording_.time[i];
      if (recording_.condition[i] != surface) {
        surface = recording_.condition[i];
        calibrator.setSurface(recording_.conditions[surface], time);
      }
      calibration::setTemperatureOf(recording_, i, *calibration_, calibrator);
      calibrator.calibrate({recording_.layout.size, recording_.full_scale, counts_[i], taxels()}, time, map);
      for (const std::size_t t : used_) {
        if (std::isnan(map.pressure[t])) continue;
        ++readings;
        constexpr std::uint16_t kAboveOrBelow =
            map::taxel_flag::kReadingExtrapolated | map::taxel_flag::kBelowRange;
        beyond += (map.flags[t] & kAboveOrBelow) ==
                  map::taxel_flag::kReadingExtrapolated;  // a taxel below is at rest
        bent += (map.flags[t] & map::taxel_flag::kCurvatureExtrapolated) != 0;
      }
      addTo(before, check_.before, map, time);
      addTo(after, check_.after, map, time);
    }
    if (readings == 0) return;
    check_.beyond = double(beyond) / double(readings);
    check_.bent_beyond = double(bent) / double(readings);
    if (!check_.before || !check_.after) return;
    std::vector<double> changes;
    for (const std::size_t t : used_) {
      if (before[t].count > 0 && after[t].count > 0) changes.push_back(after[t].mean - before[t].mean);
    }
    check_.median_pressure_change = statistics::upperMedian(changes);
  }

  // Span over which a load is averaged [s].
  double cell() const {
    const double period = recording_.time.back() / double(std::max<std::size_t>(1, recording_.scans() - 1));
    return std::max(kShortestCell, kScansOfCell * period);
  }

  // Mean reading of a taxel in each cell; NaN where no scan is under load.
  std::vector<double> byCell(std::size_t taxel, double span, const DonDoff& events) const {
    const auto cells = static_cast<std::size_t>(recording_.time.back() / span) + 1;
    std::vector<double> sums(cells, 0.0), scans(cells, 0.0);
    dataset::TaxelCounts counts(recording_, taxel);
    for (std::size_t i = 0; i < recording_.scans(); ++i) {
      const double time = recording_.time[i];
      const bool worn = time >= events.don.value_or(time) && time <= events.doff.value_or(time);
      if (!worn || mean_[i] <= rest_limit_) continue;
      const auto c = static_cast<std::size_t>(recording_.time[i] / span);
      sums[c] += share(counts[i]);
      scans[c] += 1;
    }
    for (std::size_t c = 0; c < cells; ++c) sums[c] /= scans[c];
    return sums;
  }

  // The longest period in which a taxel stays loaded and its reading varies by no more than static_range of
  // its largest reading. Both ends only move forward.
  void followLoad(std::size_t taxel, double span, const DonDoff& events) {
    const std::vector<double> load = byCell(taxel, span, events);
    std::multiset<double> loads;  // of the cells from `from` to `to`
    for (std::size_t from = 0, to = 0; to < load.size(); ++to) {
      if (!(load[to] >= kContactShare)) {  // also NaN
        from = to + 1;
        loads.clear();
        continue;
      }
      loads.insert(load[to]);
      while (*loads.rbegin() - *loads.begin() > kStaticRange * *loads.rbegin())
        loads.erase(loads.find(load[from++]));
      const double seconds = double(to - from + 1) * span;
      if (seconds > check_.longest.seconds) check_.longest = {seconds, double(from) * span, taxel};
    }
  }

  void findStaticLoad(const DonDoff& events) {
    for (const std::size_t t : used_) followLoad(t, cell(), events);
  }

  void judge() {
    auto& reasons = check_.reasons;
    if (!check_.before) reasons.push_back("no rest was recorded before: start to record before it is put on");
    if (!check_.after) reasons.push_back("no rest was recorded after: record until it is off again");
    if (double(check_.changed) > kChangedShare * double(used_.size())) {
      reasons.push_back(std::to_string(check_.changed) +
                        " taxels changed between rest before and rest after by more than " +
                        settings::percentText(kRestChange) + " of full scale");
    }
    const auto tooMany = [&](double share, double allowed, const std::string& what) {
      if (share > allowed) {
        reasons.push_back(settings::percentText(share) + " of the readings " + what +
                          " (allowed: " + settings::percentText(allowed) + ")");
      }
    };
    tooMany(check_.saturated, kSaturatedShare, "are at full scale");
    tooMany(check_.beyond, kBeyondShare, "are outside the range of training");
    tooMany(check_.bent_beyond, kBeyondShare, "have a curvature outside the range of training");
    if (check_.longest.seconds > kStaticLoad) {
      reasons.push_back("taxel " + placesText({check_.longest.taxel}, check_.layout) +
                        " carried a constant load for " + settings::fixedText(check_.longest.seconds, 0) +
                        " s, so creep may change its reading");
    }
    if (!check_.dead.empty()) reasons.push_back(std::to_string(check_.dead.size()) + " taxels are dead");
    if (!check_.stuck.empty()) reasons.push_back(std::to_string(check_.stuck.size()) + " taxels are stuck");
  }

  const dataset::Recording& recording_;
  const calibration::Calibration* calibration_;
  dataset::ScanCounts counts_;
  std::vector<std::size_t> used_;  // taxels that are not masked
  std::vector<double> mean_;       // of each scan over them [share of full scale]
  double rest_limit_ = 0;          // the same, at rest at most
  SocketCheck check_;
};

}  // namespace

SocketCheck checkSocket(const dataset::Recording& recording, const DonDoff& events,
                        const calibration::Calibration* calibration) {
  if (recording.scans() == 0) throw settings::InputError(recording.name + ": has no scan");
  return SocketChecker(recording, calibration).run(events);
}

}  // namespace fsr::check
