#include "dataset/unsound_spans.h"

#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include "dataset/reference_errors.h"
#include "settings/number_text.h"

namespace fsr::dataset {

namespace {

constexpr double kRareReadings = 0.02;  // share beyond each end of the usual range: may be faults
constexpr double kSheetAtRest = 0.1;    // share of the usual range up to which the sheet is not loaded
constexpr std::size_t kListed = 5;      // spans that are named one by one

// The reading up to which the sheet is at rest on each surface: a bent sheet has another one than a flat one.
std::map<std::uint32_t, double> restReadings(const ScanCourse& course) {
  std::map<std::uint32_t, std::vector<double>> readings;
  for (std::size_t i = 0; i < course.scans(); ++i) readings[course.condition[i]].push_back(course.reading[i]);
  std::map<std::uint32_t, double> rest;
  for (auto& [condition, values] : readings) {
    std::sort(values.begin(), values.end());
    const auto rare = static_cast<std::size_t>(kRareReadings * static_cast<double>(values.size()));
    const double low = values[rare], high = values[values.size() - 1 - rare];
    rest[condition] = low + kSheetAtRest * (high - low);
  }
  return rest;
}

std::size_t firstAfter(const ScanCourse& course, std::int64_t stamp_ns) {
  const auto found = std::upper_bound(course.stamp_ns.begin(), course.stamp_ns.end(), stamp_ns);
  return static_cast<std::size_t>(found - course.stamp_ns.begin());
}

}  // namespace

std::vector<UnsoundSpan> rejectedSpans(const ScanCourse& course, const std::vector<AttemptEnd>& ends) {
  std::vector<UnsoundSpan> spans;
  const auto misleads = [](const AttemptEnd& end) { return readingsMislead(end.reason); };
  if (std::none_of(ends.begin(), ends.end(), misleads)) return spans;
  const std::map<std::uint32_t, double> rest = restReadings(course);
  const auto rests = [&](std::size_t i) {
    return course.pressure[i] <= kRestLevel && course.reading[i] <= rest.at(course.condition[i]);
  };
  for (std::size_t e = 0; e < ends.size(); ++e) {
    if (!misleads(ends[e])) continue;
    const std::size_t least = e == 0 ? 0 : firstAfter(course, ends[e - 1].stamp_ns);
    const std::size_t most = e + 1 == ends.size() ? course.scans() : firstAfter(course, ends[e + 1].stamp_ns);
    UnsoundSpan span;
    span.first = span.end = firstAfter(course, ends[e].stamp_ns);
    // Some attempts are judged when the chamber is at rest again.
    while (span.first > least && rests(span.first - 1)) --span.first;
    while (span.first > least && !rests(span.first - 1)) --span.first;
    while (span.end < most && !rests(span.end)) ++span.end;
    span.why = "attempt rejected: " + name(ends[e].reason);
    if (span.first < span.end) spans.push_back(span);
  }
  return spans;
}

std::string unsoundText(const ScanCourse& course, const std::vector<UnsoundSpan>& spans) {
  const auto seconds = [&](std::size_t i) {
    return settings::fixedText(1e-9 * static_cast<double>(course.stamp_ns[i] - course.stamp_ns[0]), 1);
  };
  std::vector<bool> unsound(course.scans(), false);
  std::string list;
  for (std::size_t s = 0; s < spans.size(); ++s) {
    std::fill(unsound.begin() + static_cast<std::ptrdiff_t>(spans[s].first),
              unsound.begin() + static_cast<std::ptrdiff_t>(spans[s].end), true);
    if (s >= kListed) continue;
    list += (list.empty() ? "" : ", ") + seconds(spans[s].first) + " to " + seconds(spans[s].end - 1) +
            " s (" + spans[s].why + ")";
  }
  if (spans.empty()) return "";
  if (spans.size() > kListed) list += " and " + std::to_string(spans.size() - kListed) + " more";
  const auto scans = std::count(unsound.begin(), unsound.end(), true);
  return "left out " + std::to_string(scans) + (scans == 1 ? " scan that is" : " scans that are") +
         " not the sheet under the recorded pressure: " + list;
}

namespace {

constexpr std::size_t kLeastLoaded = 50;  // scans under load: with fewer a surface is not known
constexpr double kRareScans = 0.02;       // share beyond each end of a range: may be faults
// Shares of the ranges. A sheet that follows moves by more than a quarter of what the pressure does (see
// ReferenceSpikeOptions::follows), and a loaded sheet by more than a tenth of its range (see kLoaded).
constexpr double kLeastPressure = 0.25, kLeastReading = 0.1;
// A chamber cannot have less [Pa] (as the conductor of a session says). Asked only where a tenth of
// the scans is at rest: else the ambient pressure may be wrong.
constexpr double kLeastGauge = -30e3, kRestingScans = 0.1;
// Three of four scans under load differ by less than the usual difference: also where one in five is faulty.
// Six times that is 6.9 standard deviations of normal noise.
constexpr double kUsualScans = 0.75, kBeyondUsual = 6;
// A sheet turns some tenths of a second later than its load, and clocks may differ by half a second
// (discrepancy::AdmissionOptions::lag). Twice as long, or twice the lag that was found [s].
constexpr double kUsualLag = 0.5, kTimesLag = 2;
constexpr unsigned kMostRounds = 5;  // what was found is not compared with any more, until no more is found

double quantile(const std::vector<double>& sorted, double share) {
  return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))];
}

// Distance of `value` from what the other quantity says: from the values whose ranks `said` has among
// `ranks`. Positive: more is said.
double distance(const std::vector<double>& ranks, double said, const std::vector<double>& values,
                double value) {
  const auto [first, last] = std::equal_range(ranks.begin(), ranks.end(), said);
  const auto low = static_cast<std::size_t>(first - ranks.begin());
  const auto high = static_cast<std::size_t>(last - ranks.begin());
  const double least = values[low - std::min<std::size_t>(low, 1)];
  const double most = values[std::min(high, values.size() - 1)];
  return value < least ? least - value : value > most ? most - value : 0;
}

// What the scans of one surface say.
class Surface {
 public:
  Surface(const ScanCourse& course, const std::vector<std::uint32_t>& scans, const std::vector<bool>& sound)
      : course_(course) {
    // Of the sound scans above a pressure. One of these at a time: each is as long as the recording.
    const auto sorted = [&](double above, auto valueOf) {
      std::vector<double> values;
      for (const std::size_t i : scans)
        if (sound[i] && course.pressure[i] > above) values.push_back(valueOf(i));
      std::sort(values.begin(), values.end());
      return values;
    };
    pressures_ = sorted(-INFINITY, [&](std::size_t i) { return course.pressure[i]; });
    readings_ = sorted(-INFINITY, [&](std::size_t i) { return course.reading[i]; });
    const auto loads = std::upper_bound(pressures_.begin(), pressures_.end(), kRestLevel);
    const auto loaded = static_cast<std::size_t>(pressures_.end() - loads);
    if (loaded < kLeastLoaded) return;
    const double low = quantile(readings_, kRareScans), span = quantile(readings_, 1 - kRareScans) - low;
    const double range = *(loads + static_cast<std::ptrdiff_t>((1 - kRareScans) * double(loaded - 1)));
    rests_ = std::abs(quantile(pressures_, kRestingScans)) <= kRestLevel;
    // Where the chamber never comes to 0, the scans at its lowest pressure are many and agree too well.
    const double least = quantile(pressures_, kRareScans);
    const double rest = std::max(kRestLevel, least + kLeastReading * (range - least));
    usual_ = quantile(sorted(rest, [&](std::size_t i) { return std::abs(inPressure(i)); }), kUsualScans);
    const double usual_reading =
        quantile(sorted(rest, [&](std::size_t i) { return std::abs(inReading(i)); }), kUsualScans);
    least_pressure_ = std::max(kLeastPressure * range, kBeyondUsual * usual_);
    least_reading_ = std::max(kLeastReading * span, kBeyondUsual * usual_reading);
    follows_ = span > 0 && least_pressure_ < range;
  }

  bool follows() const { return follows_; }
  // How much more pressure the sheet says than the transducer [Pa].
  double inPressure(std::size_t i) const {
    return distance(readings_, course_.reading[i], pressures_, course_.pressure[i]);
  }
  bool differs(std::size_t i) const { return isBelowRest(i) || std::abs(inPressure(i)) > usual_; }
  bool contradicts(std::size_t i) const {
    return isBelowRest(i) ||
           (std::abs(inPressure(i)) > least_pressure_ && std::abs(inReading(i)) > least_reading_);
  }
  bool isBelowRest(std::size_t i) const { return rests_ && course_.pressure[i] < kLeastGauge; }

 private:
  double inReading(std::size_t i) const {
    return distance(pressures_, course_.pressure[i], readings_, course_.reading[i]);
  }

  const ScanCourse& course_;
  bool follows_ = false;                      // the pressure, so that something can contradict it
  std::vector<double> pressures_, readings_;  // of the sound scans, ascending
  bool rests_ = false;
  double usual_ = 0, least_pressure_ = 0, least_reading_ = 0;
};

// What the pressure says is too much for the reading, or too little.
std::string whyOf(const Surface& surface, std::size_t scan) {
  if (surface.isBelowRest(scan)) return "pressure below rest";
  return surface.inPressure(scan) > 0 ? "reading without pressure" : "pressure without reading";
}

// Scans in a row that differ more than usual, and contradict each other for longer than `shortest` [s].
void findOn(const Surface& surface, const ScanCourse& course, const std::vector<std::uint32_t>& scans,
            double shortest, std::vector<UnsoundSpan>& spans) {
  for (std::size_t k = 0; k < scans.size(); ++k) {
    const std::size_t begin = k;
    std::size_t first = 0, last = 0, found = 0;  // scans that contradict
    const auto inARow = [&] { return k == begin || scans[k] == scans[k - 1] + 1; };
    for (; k < scans.size() && inARow() && surface.differs(scans[k]); ++k) {
      if (!surface.contradicts(scans[k])) continue;
      last = scans[k];
      if (found++ == 0) first = last;
    }
    if (found == 0) continue;
    if (1e-9 * static_cast<double>(course.stamp_ns[last] - course.stamp_ns[first]) < shortest) continue;
    spans.push_back({scans[begin], scans[k - 1] + 1, whyOf(surface, first)});
  }
}

std::optional<ReferenceLag> lagOf(const ScanCourse& course, const std::vector<bool>& sound) {
  std::vector<double> time, reading, pressure;
  for (std::size_t i = 0; i < course.scans(); ++i) {
    if (!sound[i]) continue;
    time.push_back(1e-9 * static_cast<double>(course.stamp_ns[i] - course.stamp_ns[0]));
    reading.push_back(course.reading[i]);
    pressure.push_back(course.pressure[i]);
  }
  return referenceLag(time, reading, pressure);
}

// Longer than any lag of the clocks. Jumps may hide the lag of all scans; but where clocks differ, the sound
// scans are those that do not show it.
double shortestSpan(const ScanCourse& course, const std::vector<bool>& sound) {
  std::optional<ReferenceLag> lag = lagOf(course, std::vector<bool>(course.scans(), true));
  if (!lag) lag = lagOf(course, sound);
  const double seconds = lag ? std::abs(lag->seconds) : ReferenceLagOptions{}.longest;
  return kTimesLag * std::max(kUsualLag, seconds);
}

}  // namespace

std::vector<UnsoundSpan> contradictions(const ScanCourse& course) {
  std::map<std::uint32_t, std::vector<std::uint32_t>> surfaces;
  for (std::size_t i = 0; i < course.scans(); ++i)
    surfaces[course.condition[i]].push_back(static_cast<std::uint32_t>(i));
  std::vector<UnsoundSpan> spans;
  std::vector<bool> sound(course.scans(), true);
  double shortest = kTimesLag * kUsualLag;
  for (unsigned round = 0; round < kMostRounds; ++round) {
    std::vector<UnsoundSpan> found;
    for (const auto& [condition, scans] : surfaces) {
      const Surface surface(course, scans, sound);
      if (surface.follows()) findOn(surface, course, scans, shortest, found);
    }
    if (found.empty()) return {};
    const std::vector<bool> before = sound;
    std::fill(sound.begin(), sound.end(), true);
    for (const UnsoundSpan& span : found) {
      std::fill(sound.begin() + static_cast<std::ptrdiff_t>(span.first),
                sound.begin() + static_cast<std::ptrdiff_t>(span.end), false);
    }
    // With more it cannot be told which scans are right.
    const auto wrong = static_cast<double>(std::count(sound.begin(), sound.end(), false));
    if (wrong > (1 - kUsualScans) * static_cast<double>(course.scans())) return {};
    spans = found;
    const double longer = shortestSpan(course, sound);
    if (sound == before && longer == shortest) break;
    shortest = longer;
  }
  return spans;
}

std::vector<UnsoundSpan> unsoundSpans(const ScanCourse& course, const std::vector<AttemptEnd>& ends) {
  std::vector<UnsoundSpan> spans = rejectedSpans(course, ends);
  for (const UnsoundSpan& more : contradictions(course)) {
    const auto holds = [&](const UnsoundSpan& span) {
      return span.first <= more.first && more.end <= span.end;
    };
    if (std::none_of(spans.begin(), spans.end(), holds)) spans.push_back(more);
  }
  std::sort(spans.begin(), spans.end(),
            [](const UnsoundSpan& a, const UnsoundSpan& b) { return a.first < b.first; });
  return spans;
}

}  // namespace fsr::dataset
