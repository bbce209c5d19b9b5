#include "fsr_pressure_map/calibration/history.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "fsr_pressure_map/settings/input_error.h"

namespace fsr::calibration {

namespace {

constexpr std::array<const char*, 4> kNames = {"none", "plays", "memories", "both"};
constexpr double kSettled = 3;      // time constants; e^-3 = 5 % of a step is left
constexpr double kTimeStep = 1e-3;  // of a settling time [s]

}  // namespace

std::string historyName(HistoryFamily family) {
  return kNames.at(static_cast<std::size_t>(family));
}

HistoryFamily historyFromName(const std::string& name) {
  const auto place = std::find(kNames.begin(), kNames.end(), name);
  if (place == kNames.end())
    throw settings::InputError("history \"" + name + "\" is unknown; use none, plays, memories or both");
  return static_cast<HistoryFamily>(place - kNames.begin());
}

double settlingTime(const std::vector<double>& time_constants) {
  if (time_constants.empty()) return 0;
  return kSettled * *std::max_element(time_constants.begin(), time_constants.end());
}

double HistoryModel::smallestDeviation() const {
  double smallest = loading_deviation.empty() ? 0 : loading_deviation.front();
  for (const auto* deviation : {&loading_deviation, &unloading_deviation}) {
    for (const double value : *deviation) smallest = std::min(smallest, value);
  }
  return smallest;
}

double HistoryModel::settlingTime() const {
  const double longest = calibration::settlingTime(time_constant), allowed = smallestDeviation();
  const auto owed = [&](double time) {
    double sum = 0;  // [Pa]
    for (std::size_t k = 0; k < time_constant.size(); ++k)
      sum += std::abs(memory_weight[k]) * (knot.back() - knot.front()) * std::exp(-time / time_constant[k]);
    return sum;
  };
  double above = 0, below = longest;
  if (longest == 0 || owed(above) <= allowed) return 0;
  if (owed(below) > allowed) return longest;
  while (below - above > kTimeStep) {
    const double middle = (above + below) / 2;
    (owed(middle) > allowed ? above : below) = middle;
  }
  return below;
}

double HistoryModel::playsOwe(double lowest, double highest) const noexcept {
  const double never_below = std::max(lowest, 0.0), covered = highest - lowest;
  double owed = 0;  // [Pa]
  for (std::size_t j = 0; j < radius.size(); ++j)
    owed += std::abs(play_weight[j]) * std::max(std::min(never_below, 2 * radius[j] - covered), 0.0) / 2;
  return owed;
}

}  // namespace fsr::calibration
