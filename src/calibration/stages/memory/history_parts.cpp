#include "calibration/stages/memory/history_parts.h"

#include <algorithm>

#include "settings/number_text.h"

namespace fsr::calibration {

namespace {

constexpr std::array<double, 6> kTimes = {0.3, 1, 3, 10, 30, 100};  // since the last reversal [s]
constexpr std::size_t kLoading = 1, kUnloading = 2, kFirstTime = 3;

std::string timeName(std::size_t place) {
  const std::string unit = " s since the reversal";
  if (place == 0) return "up to " + settings::roundedText(kTimes.front()) + unit;
  if (place == kTimes.size()) return "over " + settings::roundedText(kTimes.back()) + unit;
  return settings::roundedText(kTimes[place - 1]) + " to " + settings::roundedText(kTimes[place]) + unit;
}

}  // namespace

std::array<std::size_t, 3> historyPartsOf(statistics::LoadDirection direction, double since_reversal) {
  const auto time = std::upper_bound(kTimes.begin(), kTimes.end(), since_reversal) - kTimes.begin();
  const std::size_t by_time = kFirstTime + static_cast<std::size_t>(time);
  switch (direction) {
    case statistics::LoadDirection::kLoading:
      return {0, kLoading, by_time};
    case statistics::LoadDirection::kUnloading:
      return {0, kUnloading, by_time};
    case statistics::LoadDirection::kNone:
      break;
  }
  return {0, by_time, by_time};
}

std::string historyPartName(std::size_t part) {
  if (part == 0) return "all readings";
  if (part == kLoading) return "loading";
  if (part == kUnloading) return "unloading";
  return timeName(part - kFirstTime);
}

}  // namespace fsr::calibration
