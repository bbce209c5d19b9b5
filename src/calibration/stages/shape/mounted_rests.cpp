#include "calibration/stages/shape/mounted_rests.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>

#include "dataset/count_readers.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "settings/number_text.h"

namespace fsr::calibration {

namespace {

constexpr double kNoRest = std::numeric_limits<double>::quiet_NaN();

// The mean of several readings of one mount.
RestReading meanOf(const std::vector<RestReading>& readings) {
  RestReading mean = readings.front();
  for (std::size_t t = 0; t < mean.reading.size(); ++t) {
    double sum = 0, count = 0;
    for (const RestReading& one : readings) {
      mean.zero[t] = std::max(mean.zero[t], one.zero[t]);
      if (std::isnan(one.reading[t])) continue;
      sum += one.reading[t];
      count += 1;
    }
    mean.reading[t] = count > 0 ? sum / count : kNoRest;
  }
  return mean;
}

// Whether the chamber is at ambient during the rest, so that there is no load on the sheet.
bool unloaded(const dataset::Recording& recording, const std::vector<std::size_t>& rest) {
  return !rest.empty() && std::all_of(rest.begin(), rest.end(), [&](std::size_t scan) {
    return std::abs(recording.pressure[scan]) <= kUnloaded;
  });
}

// By curvature class and mount number.
using SessionsByMount = std::map<std::pair<std::size_t, std::uint32_t>, std::vector<const Session*>>;

// Those that start at rest, or those that do not.
SessionsByMount sessionsByMount(const std::vector<dataset::Recording>& recordings, const Sessions& sessions,
                                bool at_rest) {
  SessionsByMount by_mount;
  for (const Session& session : sessions.all) {
    const matrix::Surface& surface = recordings[session.recording].conditions[session.condition];
    if (unloaded(recordings[session.recording], session.rest.scans) == at_rest)
      by_mount[{session.curvature_class, surface.mount}].push_back(&session);
  }
  return by_mount;
}

// Mean over the scans [degree Celsius]; NaN = not recorded.
double temperatureAt(const dataset::Recording& recording, const std::vector<std::size_t>& scans) {
  if (recording.temperature.empty()) return kNoRest;
  double sum = 0;
  for (const std::size_t scan : scans) sum += recording.temperature[scan];
  return sum / double(scans.size());
}

// Of the readings of each taxel [counts].
std::vector<double> difference(const RestReading& after, const RestReading& before) {
  std::vector<double> change(after.reading.size());
  std::transform(after.reading.begin(), after.reading.end(), before.reading.begin(), change.begin(),
                 std::minus<>());
  return change;
}

}  // namespace

RestReading readingAtRest(const dataset::Recording& recording, const std::vector<std::size_t>& scans) {
  const std::size_t taxels = recording.layout.size.taxels();
  RestReading rest{std::vector<double>(taxels, kNoRest), std::vector<std::uint8_t>(taxels, 0)};
  for (std::size_t t = 0; t < taxels; ++t) {
    if (scans.empty() || (!recording.mask.empty() && recording.mask[t] != 0)) continue;
    double sum = 0, zeros = 0;
    dataset::TaxelCounts counts(recording, t);
    for (const std::size_t scan : scans) {
      sum += counts[scan];
      zeros += counts[scan] == 0 ? 1 : 0;
    }
    rest.reading[t] = sum / double(scans.size());
    rest.zero[t] = zeros > kCutShare * double(scans.size()) ? 1 : 0;
  }
  return rest;
}

std::vector<MountedRest> mountedRests(const std::vector<dataset::Recording>& recordings,
                                      const Sessions& sessions) {
  const SessionsByMount by_mount = sessionsByMount(recordings, sessions, true);
  std::vector<MountedRest> mounts;
  for (const auto& [key, members] : by_mount) {
    std::vector<RestReading> readings;
    for (const Session* session : members)
      readings.push_back(readingAtRest(recordings[session->recording], session->rest.scans));
    const Session& first = *members.front();
    MountedRest mount{first.name(recordings),
                      recordings[first.recording].conditions[first.condition],
                      key.first,
                      meanOf(readings),
                      recordings[first.recording].sensor.serial,
                      temperatureAt(recordings[first.recording], first.rest.scans),
                      {}};
    const std::vector<std::size_t> end = restAfterLoad(recordings[first.recording], first.condition);
    if (!end.empty())
      mount.left_behind = difference(readingAtRest(recordings[first.recording], end),
                                     readingAtRest(recordings[first.recording], first.rest.scans));
    mounts.push_back(std::move(mount));
  }
  return mounts;
}

std::vector<std::string> mountsWithoutRest(const std::vector<dataset::Recording>& recordings,
                                           const Sessions& sessions) {
  const SessionsByMount with = sessionsByMount(recordings, sessions, true);
  std::vector<std::string> names;
  for (const auto& [key, members] : sessionsByMount(recordings, sessions, false)) {
    if (with.count(key) == 0) names.push_back(members.front()->name(recordings));
  }
  return names;
}

RestWindow::RestWindow(const ShapeModel& model, const TareOptions& options)
    : layout_(model.layout),
      full_scale_(model.full_scale),
      scale_(model.scale),
      options_(options),
      moments_(model.used.size()),
      zeros_(model.used.size(), 0.0) {}

bool RestWindow::add(const matrix::ScanView& scan, const std::vector<std::uint8_t>& ignored, double time) {
  if (scan.size != layout_.size || scan.full_scale != full_scale_ || scan.count != moments_.size())
    return false;
  if (scans_ == 0 || time < last_) {
    moments_.assign(moments_.size(), {});
    zeros_.assign(zeros_.size(), 0.0);
    scans_ = 0;
    start_ = time;
  }
  last_ = time;
  ++scans_;
  for (std::size_t t = 0; t < moments_.size(); ++t) {
    if (t < ignored.size() && ignored[t] != 0) continue;
    moments_[t].add(scan.counts[t]);
    zeros_[t] += scan.counts[t] == 0 ? 1 : 0;
  }
  return scans_ >= options_.least_scans && time - start_ >= options_.window;
}

RestReading RestWindow::reading() const {
  RestReading rest;
  double widest = 0;
  std::size_t worst = 0;
  for (std::size_t t = 0; t < moments_.size(); ++t) {
    const statistics::RunningMoments& m = moments_[t];
    rest.reading.push_back(m.count > 0 ? m.mean : std::numeric_limits<double>::quiet_NaN());
    rest.zero.push_back(zeros_[t] > kCutShare * m.count ? 1 : 0);
    const double deviation = m.deviation() * scale_[t] / full_scale_;
    if (deviation <= widest) continue;
    widest = deviation;
    worst = t;
  }
  if (widest > options_.scatter) {
    throw settings::InputError(
        "how the sheet lies cannot be told: taxel (" + std::to_string(layout_.row({worst})) + ", " +
        std::to_string(layout_.column({worst})) + ") scatters by " + settings::roundedText(widest / 1000, 2) +
        " kPa, so the sheet is not at rest; unload it");
  }
  return rest;
}

}  // namespace fsr::calibration
