#include "fsr_pressure_map/exports/scan_record.h"

#include <array>
#include <utility>

namespace fsr {

std::string flagWords(std::uint16_t flags) {
  static const std::array<std::pair<std::uint16_t, const char*>, 12> kWords = {{
      {taxel_flag::kSaturated, "SATURATED"},
      {taxel_flag::kDead, "DEAD"},
      {taxel_flag::kStuck, "STUCK"},
      {taxel_flag::kReadingExtrapolated, "READING_EXTRAPOLATED"},
      {taxel_flag::kCurvatureExtrapolated, "CURVATURE_EXTRAPOLATED"},
      {taxel_flag::kBetweenClasses, "BETWEEN_CLASSES"},
      {taxel_flag::kFilled, "FILLED"},
      {taxel_flag::kMasked, "MASKED"},
      {taxel_flag::kLineFault, "LINE_FAULT"},
      {taxel_flag::kTared, "TARED"},
      {taxel_flag::kBelowRange, "BELOW_RANGE"},
      {taxel_flag::kTemperatureExtrapolated, "TEMPERATURE_EXTRAPOLATED"},
  }};
  std::string words;
  for (const auto& [bit, word] : kWords) {
    if ((flags & bit) != 0) words += (words.empty() ? "" : "|") + std::string(word);
  }
  return words.empty() ? "none" : words;
}

std::string stateWord(MapState state) {
  switch (state) {
    case MapState::kOk:
      return "OK";
    case MapState::kUncalibrated:
      return "UNCALIBRATED";
    case MapState::kCurvatureUnknown:
      return "CURVATURE_UNKNOWN";
    case MapState::kCurvatureStale:
      return "CURVATURE_STALE";
    case MapState::kSizeMismatch:
      return "SIZE_MISMATCH";
    case MapState::kWrongSensor:
      return "WRONG_SENSOR";
  }
  return "UNKNOWN";
}

}  // namespace fsr
