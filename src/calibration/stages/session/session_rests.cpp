#include "calibration/stages/session/session_rests.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "calibration/stages/session/tare.h"
#include "dataset/count_readers.h"
#include "settings/number_text.h"
#include "statistics/samples.h"

namespace fsr::calibration {

namespace {

constexpr double kWindow = 0.2;  // over which the median of the pressure is taken [s]
// How far a rest may be above the lowest level that the chamber holds: share of the range of the session, and
// at least this.
constexpr double kShareOfRange = 0.01;
constexpr double kLeast = 2e3;  // [Pa]
// A chamber above this share of the highest pressure of the session, and above this pressure, loads the
// sheet.
constexpr double kShareOfLoad = 0.05;
constexpr double kLeastLoad = 5e3;  // [Pa]
// Change between the two halves of a rest, which noise may exceed by this many of its deviations.
constexpr double kDrift = 0.5e3;  // [Pa]
constexpr double kDeviations = 3;
constexpr double kOutliers = 0.1;  // share of the windows that may be beyond the limits

// Where the chamber rests in a session, by the medians of the pressure in windows of 0.2 s.
class SessionPressure {
 public:
  SessionPressure(const dataset::Recording& recording, std::size_t condition) : recording_(recording) {
    for (std::size_t i = 0; i < recording.scans(); ++i) {
      if (recording.condition[i] == condition && std::isfinite(recording.pressure[i])) scans_.push_back(i);
    }
    for (std::size_t begin = 0, end = 0; begin < scans_.size(); begin = end) {
      const auto window = [&](std::size_t at) {
        return std::floor((timeOf(at) - timeOf(0)) / kWindow + kRounding);
      };
      std::vector<double> pressures;
      for (; end < scans_.size() && window(end) == window(begin); ++end)
        pressures.push_back(recording.pressure[scans_[end]]);
      windows_.push_back({begin, statistics::upperMedian(pressures)});
    }
    for (std::size_t w = 0; w < windows_.size(); ++w) {
      if (const auto span = spanFrom(w)) lowest_ = std::min(lowest_, levelOf(*span));
      highest_ = std::max(highest_, windows_[w].median);
    }
    allowed_ = lowest_ + std::max(kLeast, kShareOfRange * (highest_ - lowest_));
  }

  std::size_t windows() const { return windows_.size(); }
  bool loaded(std::size_t window) const { return windows_[window].median > allowed_; }

  // Why there is no rest that begins with a window; else empty, and `rest` receives its scans.
  std::string findRest(std::size_t window, std::vector<std::size_t>& rest) const {
    const auto span = spanFrom(window);
    if (!span) return "it is shorter than " + settings::roundedText(options_.window, 2) + " s";
    const double level = levelOf(*span);
    if (level > std::max(kLeastLoad, kShareOfLoad * highest_))
      return "the chamber is at " + settings::fixedPressure(level, 1) + ", which is a load";
    if (level > allowed_) {
      return "the chamber is at " + settings::fixedPressure(level, 1) +
             ", but the lowest level that it holds later is " + settings::fixedPressure(lowest_, 1);
    }
    const std::vector<double> medians = mediansOf(*span);
    const auto half = medians.begin() + std::ptrdiff_t(medians.size() / 2);
    const double before = statistics::upperMedian({medians.begin(), half}, level);
    const double after = statistics::upperMedian({half, medians.end()});
    const double noise = noiseOf(medians), limit = allowed_ - lowest_ + kDeviations * noise;
    const auto beyond = std::count_if(medians.begin(), medians.end(),
                                      [&](double median) { return std::abs(median - level) > limit; });
    if (std::abs(after - before) > kDrift + kDeviations * noise ||
        double(beyond) > kOutliers * double(medians.size())) {
      const auto [low, high] = std::minmax_element(medians.begin(), medians.end());
      return "the chamber moves between " + settings::fixedPressure(*low, 1) + " and " +
             settings::fixedPressure(*high, 1);
    }
    for (std::size_t i = span->begin; i < span->end; ++i) {  // without spikes
      if (std::abs(recording_.pressure[scans_[i]] - level) <= limit) rest.push_back(scans_[i]);
    }
    return "";
  }

 private:
  static constexpr double kRounding = 1e-6;  // of the stamps, share of a window

  struct Window {
    std::size_t begin;  // index into scans_
    double median;      // [Pa]
  };
  // Windows, and scans by their index into scans_.
  struct Span {
    std::size_t first, last, begin, end;
  };

  double timeOf(std::size_t at) const { return recording_.time[scans_[at]]; }

  // As long as a live tare averages.
  std::optional<Span> spanFrom(std::size_t window) const {
    const std::size_t begin = windows_[window].begin;
    const double until = timeOf(begin) + options_.window - kRounding * kWindow;
    const auto last =
        std::lower_bound(scans_.begin() + std::ptrdiff_t(begin), scans_.end(), until,
                         [&](std::size_t scan, double time) { return recording_.time[scan] < time; });
    const std::size_t end = std::max(std::size_t(last - scans_.begin()) + 1, begin + options_.least_scans);
    if (end > scans_.size()) return {};
    const auto after = std::lower_bound(windows_.begin(), windows_.end(), end,
                                        [](const Window& one, std::size_t at) { return one.begin < at; });
    return Span{window, std::size_t(after - windows_.begin()), begin, end};
  }

  std::vector<double> mediansOf(const Span& span) const {
    std::vector<double> medians;
    for (std::size_t w = span.first; w < span.last; ++w) medians.push_back(windows_[w].median);
    return medians;
  }
  double levelOf(const Span& span) const { return statistics::upperMedian(mediansOf(span)); }

  // Standard deviation of the medians, by their steps, so that a slow ramp is no noise [Pa].
  static double noiseOf(const std::vector<double>& medians) {
    std::vector<double> steps;
    for (std::size_t w = 1; w < medians.size(); ++w) steps.push_back(medians[w] - medians[w - 1]);
    const double middle = statistics::upperMedian(steps, 0);
    for (double& step : steps) step = std::abs(step - middle);
    return statistics::kDeviationPerMedian * statistics::upperMedian(steps, 0) / std::sqrt(2.0);
  }

  const dataset::Recording& recording_;
  const TareOptions options_{};
  std::vector<std::size_t> scans_;
  std::vector<Window> windows_;
  double lowest_ = std::numeric_limits<double>::infinity();  // level that the chamber holds [Pa]
  double highest_ = -lowest_;                                // [Pa]
  double allowed_ = 0;                                       // of a window at rest [Pa]
};

}  // namespace

std::vector<std::size_t> restAtStart(const dataset::Recording& recording, std::size_t condition) {
  std::vector<std::size_t> rest;
  const SessionPressure session(recording, condition);
  if (session.windows() > 0) session.findRest(0, rest);
  return rest;
}

std::string whyNoRest(const dataset::Recording& recording, std::size_t condition) {
  std::vector<std::size_t> rest;
  const SessionPressure session(recording, condition);
  const std::string why = session.windows() > 0 ? session.findRest(0, rest) : "it has no scan";
  return why.empty() ? "" : "it does not start with 2 s at rest: " + why;
}

std::vector<std::size_t> restAfterLoad(const dataset::Recording& recording, std::size_t condition) {
  const SessionPressure session(recording, condition);
  std::vector<std::size_t> last, found;
  bool loaded = false, open = false;  // open: no rest was found since the last load
  for (std::size_t window = 0; window < session.windows(); ++window) {
    if (session.loaded(window)) {
      loaded = open = true;
    } else if (open && loaded) {
      found.clear();
      if (!session.findRest(window, found).empty()) continue;
      last = found;
      open = false;
    }
  }
  return last;
}

std::vector<ReadingAtRest> readingsAtRest(const dataset::Recording& recording,
                                          const std::vector<std::size_t>& rest, std::size_t taxel) {
  std::map<std::uint16_t, ReadingAtRest> readings;
  dataset::TaxelCounts counts(recording, taxel);
  for (const std::size_t scan : rest) {
    const std::uint16_t code = counts[scan];
    if (code >= recording.full_scale) continue;
    ReadingAtRest& reading = readings[code];
    reading.code = code;
    reading.count += 1;
    reading.pressure += (recording.pressure[scan] - reading.pressure) / reading.count;
  }
  std::vector<ReadingAtRest> result;
  for (const auto& [code, reading] : readings) result.push_back(reading);
  return result;
}

std::optional<double> zeroAtRest(const dataset::Recording& recording, const StartRest& rest,
                                 std::size_t taxel, const std::vector<double>& table) {
  std::optional<double> zero = zeroAtRest(readingsAtRest(recording, rest.scans, taxel), table);
  if (zero && rest.trained) zero = *zero - zeroInTraining(*rest.trained, taxel, table);
  return zero;
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
      sessions.all.push_back({r, c, classes.class_of[r][c], 0, {restAtStart(recordings[r], c), nullptr}});
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

void referToTraining(const std::vector<dataset::Recording>& recordings, const compensation::SchemePlan& plan,
                     Sessions& sessions) {
  std::vector<std::shared_ptr<TrainedRests>> of_model(plan.models.size());
  for (std::shared_ptr<TrainedRests>& rests : of_model) rests = std::make_shared<TrainedRests>();
  for (Session& session : sessions.all) {
    if (session.rest.empty()) continue;
    const std::shared_ptr<TrainedRests>& rests = of_model[plan.model_of_class[session.curvature_class]];
    session.rest.trained = rests;
    if (!plan.trainsOn(session.curvature_class)) continue;
    const dataset::Recording& recording = recordings[session.recording];
    std::vector<std::vector<ReadingAtRest>>& taxels = rests->emplace_back();
    for (std::size_t taxel = 0; taxel < recording.layout.size.taxels(); ++taxel)
      taxels.push_back(readingsAtRest(recording, session.rest.scans, taxel));
  }
}

}  // namespace fsr::calibration
