#include "discrepancy/samples/available_evidence.h"

#include <algorithm>
#include <cmath>

#include "discrepancy/thresholds.h"

namespace fsr::discrepancy {

namespace {

// Share of a covariate's standard deviation that a linear function of clock time must leave unexplained.
constexpr double kUnevenPace = 0.2;
constexpr double kLongPause = 3600;      // [s]
constexpr double kTemperatureMoved = 5;  // [K]

bool temperatureMoved(const Measured& measured) {
  if (measured.temperature.empty()) return false;
  const auto [low, high] = std::minmax_element(measured.temperature.begin(), measured.temperature.end());
  return *high - *low > kTemperatureMoved;
}

// Whether a covariate can be distinguished from clock time. This requires a long pause between two cycles,
// and values at the starts of the cycles that are not a linear function of clock time.
bool wentApart(const Measured& measured, const std::vector<double>& covariate) {
  if (covariate.empty()) return false;
  double sum_t = 0, sum_w = 0, tt = 0, ww = 0, tw = 0, longest = 0;
  for (std::size_t c = 0; c < measured.cycles.size(); ++c) {
    const std::size_t first = measured.cycles[c].first;
    const double t = measured.time[first], w = covariate[first];
    sum_t += t, sum_w += w, tt += t * t, ww += w * w, tw += t * w;
    if (c > 0) longest = std::max(longest, t - measured.time[measured.cycles[c - 1].last - 1]);
  }
  const auto n = static_cast<double>(measured.cycles.size());
  const double var_t = tt - sum_t * sum_t / n, var_w = ww - sum_w * sum_w / n, both = tw - sum_t * sum_w / n;
  if (longest < kLongPause || var_t <= 0 || var_w <= 0) return false;
  return 1 - both * both / (var_t * var_w) > kUnevenPace * kUnevenPace;
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
    default:
      return false;
  }
}

AvailableEvidence availableEvidence(const Measured& measured) {
  AvailableEvidence evidence;
  evidence.thermometer = !measured.temperature.empty();
  evidence.uneven_pace = wentApart(measured, measured.path_length);
  evidence.temperature_moved = temperatureMoved(measured);
  evidence.uneven_warmth = evidence.temperature_moved && wentApart(measured, measured.temperature);
  evidence.remounted = measured.classes.size() < measured.visits.size();
  evidence.mount_labels = std::all_of(measured.visits.begin(), measured.visits.end(),
                                      [](const Visit& v) { return v.surface.mount > 0; });
  // With ramps of one speed, the rates have one peak. Dwells under load are samples at which the pressure
  // does not change.
  const double highest = *std::max_element(measured.pressure.begin(), measured.pressure.end());
  std::vector<double> moving;
  double still = 0, loaded = 0;
  double fastest = 0;
  for (const double r : measured.rate) fastest = std::max(fastest, std::abs(r));
  for (std::size_t i = 0; i < measured.samples(); ++i) {
    if (measured.pressure[i] < thresholds::kLoaded * highest) continue;
    ++loaded;
    if (std::abs(measured.rate[i]) < 0.02 * fastest)
      ++still;
    else
      moving.push_back(std::abs(measured.rate[i]));
  }
  std::sort(moving.begin(), moving.end());
  const auto at = [&](double share) {
    return moving.empty() ? 0
                          : moving[static_cast<std::size_t>(share * static_cast<double>(moving.size() - 1))];
  };
  evidence.two_rates = at(0.1) > 0 && at(0.9) > 1.5 * at(0.1);
  evidence.two_rates = evidence.two_rates || still > 0.1 * loaded;
  return evidence;
}

}  // namespace fsr::discrepancy
