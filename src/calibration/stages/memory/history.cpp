#include "fsr_pressure_map/calibration/history.h"

#include <algorithm>
#include <array>

#include "fsr_pressure_map/settings/input_error.h"

namespace fsr::calibration {

namespace {

constexpr std::array<const char*, 4> kNames = {"none", "plays", "memories", "both"};

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

}  // namespace fsr::calibration
