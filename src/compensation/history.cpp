#include "fsr_pressure_map/compensation/history.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "fsr_pressure_map/settings/input_error.h"

namespace fsr::compensation {

namespace {

constexpr std::array<const char*, 4> kNames = {"none", "plays", "memories", "both"};
constexpr double kSettled = 3;  // time constants; e^-3 = 5 % of a step is left

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

double HistoryModel::settlingSpan() const {
  double allowed = loading_deviation.empty() ? 0 : loading_deviation.front();
  for (const auto* deviation : {&loading_deviation, &unloading_deviation}) {
    for (const double value : *deviation) allowed = std::min(allowed, value);
  }
  std::vector<std::size_t> widest(radius.size());
  for (std::size_t j = 0; j < widest.size(); ++j) widest[j] = j;
  std::sort(widest.begin(), widest.end(), [&](auto a, auto b) { return radius[a] > radius[b]; });
  double owed = 0;  // by the plays that need not have settled [Pa]
  for (const std::size_t j : widest) {
    owed += std::abs(play_weight[j]) * radius[j];
    if (owed > allowed) return 2 * radius[j];
  }
  return 0;
}

}  // namespace fsr::compensation
