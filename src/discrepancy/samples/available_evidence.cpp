#include "discrepancy/samples/available_evidence.h"

#include <algorithm>
#include <cmath>

#include "discrepancy/samples/measured.h"
#include "statistics/samples.h"

namespace fsr::discrepancy {

namespace {

// Share of the path length's standard deviation that a linear function of clock time must leave unexplained.
constexpr double kUnevenPace = 0.2;
constexpr double kLongPause = 3600;  // [s]
constexpr double kNewSession = 10;   // interruption after which the effects begin a new session [s]

// Whether the path length of the load can be distinguished from clock time. This requires a long pause
// between two cycles, and path lengths at the starts of the cycles that are not a linear function of clock
// time.
bool unevenPace(const Measured& measured) {
  double sum_t = 0, sum_w = 0, tt = 0, ww = 0, tw = 0, longest = 0;
  for (std::size_t c = 0; c < measured.cycles.size(); ++c) {
    const std::size_t first = measured.cycles[c].first;
    const double t = measured.time[first], w = measured.path_length[first];
    sum_t += t, sum_w += w, tt += t * t, ww += w * w, tw += t * w;
    if (c > 0) longest = std::max(longest, t - measured.time[measured.cycles[c - 1].last - 1]);
  }
  const auto n = static_cast<double>(measured.cycles.size());
  const double var_t = tt - sum_t * sum_t / n, var_w = ww - sum_w * sum_w / n, both = tw - sum_t * sum_w / n;
  if (longest < kLongPause || var_t <= 0 || var_w <= 0) return false;
  return 1 - both * both / (var_t * var_w) > kUnevenPace * kUnevenPace;
}

// Whether the same pressures were passed at two rates, or held. A sine of one frequency has many rates, but
// at each pressure only one. Dwells under load are samples at which the pressure does not change.
bool twoRatesOrDwells(const Measured& measured) {
  constexpr std::size_t kPressures = 10, kFew = 5;
  constexpr double kStill = 0.02;  // of the fastest rate
  constexpr double kDwells = 0.1;  // of the samples under load
  constexpr double kTwice = 1.5;   // ratio of two rates
  const double highest = *std::max_element(measured.pressure.begin(), measured.pressure.end());
  double still = 0, loaded = 0, fastest = 0;
  for (const double r : measured.rate) fastest = std::max(fastest, std::abs(r));
  std::vector<std::vector<double>> rates(2 * kPressures);
  for (std::size_t i = 0; i < measured.samples(); ++i) {
    const double share = (measured.pressure[i] / highest - thresholds::kLoaded) / (1 - thresholds::kLoaded);
    if (share < 0) continue;
    ++loaded;
    const double rate = measured.rate[i];
    const auto at = std::min(kPressures - 1, static_cast<std::size_t>(share * kPressures));
    if (std::abs(rate) < kStill * fastest)
      ++still;
    else
      rates[2 * at + (rate > 0 ? 1 : 0)].push_back(std::abs(rate));
  }
  if (still > kDwells * loaded) return true;
  std::vector<double> ratios;
  for (std::vector<double>& here : rates) {
    if (here.size() < kFew) continue;
    std::sort(here.begin(), here.end());
    ratios.push_back(here[(here.size() - 1) * 9 / 10] / here[(here.size() - 1) / 10]);
  }
  return statistics::upperMedian(ratios, 0) > kTwice;
}

// Whether a mount was recorded again after an interruption that begins a new session.
bool interrupted(const Measured& measured) {
  for (std::size_t v = 1; v < measured.visits.size(); ++v) {
    const Visit &before = measured.visits[v - 1], &now = measured.visits[v];
    const bool same = before.surface.name == now.surface.name && before.surface.mount == now.surface.mount;
    const double pause = measured.time[now.first] - measured.time[before.last - 1];
    if (same && before.recording != now.recording && pause >= kNewSession) return true;
  }
  return false;
}

}  // namespace

bool AvailableEvidence::has(simulation::Evidence evidence) const {
  switch (evidence) {
    case simulation::Evidence::kThermometer:
      return thermometer;
    case simulation::Evidence::kTwoRampRates:
      return two_rates;
    case simulation::Evidence::kMountLabels:
      return mount_labels;
    case simulation::Evidence::kRemounts:
      return remounted;
    case simulation::Evidence::kManyCycles:
    case simulation::Evidence::kUnevenPace:
      return uneven_pace;
    case simulation::Evidence::kTwoSessions:
      return two_sessions;
    default:
      return false;
  }
}

bool AvailableEvidence::hasAll(const std::vector<simulation::Evidence>& evidence) const {
  return std::all_of(evidence.begin(), evidence.end(), [this](simulation::Evidence e) { return has(e); });
}

std::set<simulation::Evidence> AvailableEvidence::lacking(
    const std::vector<simulation::Evidence>& evidence) const {
  std::set<simulation::Evidence> lacking;
  for (const simulation::Evidence need : evidence) {
    const bool can = need == simulation::Evidence::kTwoRampRates ||
                     need == simulation::Evidence::kThermometer || need == simulation::Evidence::kManyCycles;
    if (can && !has(need)) lacking.insert(need);
  }
  return lacking;
}

AvailableEvidence availableEvidence(const Measured& measured) {
  AvailableEvidence evidence;
  evidence.thermometer = !measured.temperature.empty();
  evidence.uneven_pace = unevenPace(measured);
  evidence.two_sessions = interrupted(measured);
  const std::vector<std::size_t> mounts = measured.mounts();
  evidence.remounted = *std::max_element(mounts.begin(), mounts.end()) > 1;
  evidence.mount_labels = std::all_of(measured.visits.begin(), measured.visits.end(),
                                      [](const Visit& v) { return v.surface.mount > 0; });
  evidence.two_rates = twoRatesOrDwells(measured);
  return evidence;
}

}  // namespace fsr::discrepancy
