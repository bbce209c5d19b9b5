#include "calibration/stages/session/session_rests.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "calibration/stages/session/tare.h"
#include "dataset/count_readers.h"

namespace fsr::calibration {

namespace {

// How far the chamber may be above its lowest pressure in a rest: share of the range of the session, and at
// least this, so that noise of the reference ends no rest.
constexpr double kShareOfRange = 0.01;
constexpr double kLeast = 2e3;  // [Pa]

// The scans of a session, and the pressure up to which the chamber is at rest [Pa].
struct SessionScans {
  SessionScans(const dataset::Recording& recording, std::size_t condition) {
    double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
    for (std::size_t i = 0; i < recording.scans(); ++i) {
      if (recording.condition[i] != condition || !std::isfinite(recording.pressure[i])) continue;
      scans.push_back(i);
      lowest = std::min(lowest, recording.pressure[i]);
      highest = std::max(highest, recording.pressure[i]);
    }
    allowed = lowest + std::max(kLeast, kShareOfRange * (highest - lowest));
  }

  std::vector<std::size_t> scans;
  double allowed = 0;
};

}  // namespace

std::vector<std::size_t> restAtStart(const dataset::Recording& recording, std::size_t condition) {
  const SessionScans session(recording, condition);
  const TareOptions window;
  std::vector<std::size_t> rest;
  for (const std::size_t scan : session.scans) {
    if (recording.pressure[scan] > session.allowed) return {};
    rest.push_back(scan);
    const double duration = recording.time[scan] - recording.time[rest.front()];
    if (rest.size() >= window.least_scans && duration >= window.window) return rest;
  }
  return {};
}

std::vector<std::size_t> restAfterLoad(const dataset::Recording& recording, std::size_t condition) {
  const SessionScans session(recording, condition);
  const TareOptions window;
  std::vector<std::size_t> rest, last;
  bool loaded = false;
  for (const std::size_t scan : session.scans) {
    if (recording.pressure[scan] > session.allowed) {
      loaded = true;
      rest.clear();
    } else if (loaded &&
               (rest.empty() || recording.time[scan] - recording.time[rest.front()] <= window.window)) {
      rest.push_back(scan);
      if (rest.size() >= window.least_scans) last = rest;
    }
  }
  return last;
}

std::vector<ReadingAtRest> readingsAtRest(const dataset::Recording& recording,
                                          const std::vector<std::size_t>& rest, std::size_t taxel) {
  std::vector<ReadingAtRest> readings;
  dataset::TaxelCounts counts(recording, taxel);
  for (const std::size_t scan : rest) {
    const std::uint16_t code = counts[scan];
    if (code < recording.full_scale) readings.push_back({code, recording.pressure[scan]});
  }
  return readings;
}

std::optional<double> zeroAtRest(const std::vector<ReadingAtRest>& readings,
                                 const std::vector<double>& table) {
  if (table.empty() || readings.empty()) return {};
  double sum = 0;
  for (const ReadingAtRest& reading : readings) sum += table[reading.code] - reading.pressure;
  return sum / static_cast<double>(readings.size());
}

std::optional<double> zeroAtRest(const dataset::Recording& recording, const std::vector<std::size_t>& rest,
                                 std::size_t taxel, const std::vector<double>& table) {
  return zeroAtRest(readingsAtRest(recording, rest, taxel), table);
}

std::string Session::name(const std::vector<dataset::Recording>& recordings) const {
  const matrix::Surface& surface = recordings[recording].conditions[condition];
  std::string text = recordings[recording].name;
  if (!surface.name.empty()) text += ", " + surface.name;
  if (surface.mount != 0) text += ", mount " + std::to_string(surface.mount);
  return text;
}

bool Sessions::assessable() const {
  return std::any_of(rests.begin(), rests.end(), [](std::size_t count) { return count > 1; });
}

Sessions findSessions(const std::vector<dataset::Recording>& recordings,
                      const dataset::ConditionClasses& classes) {
  Sessions sessions;
  for (std::size_t r = 0; r < recordings.size(); ++r) {
    for (std::size_t c = 0; c < recordings[r].conditions.size(); ++c)
      sessions.all.push_back({r, c, classes.class_of[r][c], 0, restAtStart(recordings[r], c)});
  }
  std::vector<std::uint32_t> next(classes.classes.size(), 0);
  const auto number = [&](bool with_rest) {
    for (Session& session : sessions.all) {
      if (session.rest.empty() != with_rest) session.number = next[session.curvature_class]++;
    }
  };
  number(true);
  sessions.rests.assign(next.begin(), next.end());
  number(false);
  for (const std::uint32_t count : next) sessions.most = std::max(sessions.most, std::size_t(count));
  return sessions;
}

}  // namespace fsr::calibration
