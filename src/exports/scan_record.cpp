#include "exports/scan_record.h"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <utility>

#include "fsr_pressure_map/settings/input_error.h"

namespace fsr::exports {

namespace {

template <typename T>
std::string shortest(T value) {
  if (std::isnan(value)) return "NA";
  std::array<char, 32> text{};
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

}  // namespace

std::string exactText(float value) {
  return shortest(value);
}

std::string exactText(double value) {
  return shortest(value);
}

std::string dateText(std::int64_t stamp_ns, const char* format) {
  const std::time_t seconds = stamp_ns / 1000000000;
  std::tm parts{};
  gmtime_r(&seconds, &parts);
  std::array<char, 40> text{};
  std::strftime(text.data(), text.size(), format, &parts);
  return text.data();
}

std::string secondsText(std::int64_t nanoseconds) {
  constexpr std::int64_t kSecond = 1000000000;
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), "%s%lld.%09lld", nanoseconds < 0 ? "-" : "",
                std::llabs(nanoseconds / kSecond), std::llabs(nanoseconds % kSecond));
  return text.data();
}

void requireOneSize(const ExportSubject& subject, matrix::MatrixSize first, matrix::MatrixSize now,
                    const std::string& holds) {
  if (now == first) return;
  throw settings::InputError(subject.name + ": the matrix changes from " + matrix::sizeText(first) + " to " +
                             matrix::sizeText(now) + " taxels, but " + holds +
                             " one size; end the export before the change with --until");
}

std::string flagWords(std::uint16_t flags) {
  static const std::array<std::pair<std::uint16_t, const char*>, 13> kWords = {{
      {map::taxel_flag::kSaturated, "SATURATED"},
      {map::taxel_flag::kDead, "DEAD"},
      {map::taxel_flag::kStuck, "STUCK"},
      {map::taxel_flag::kReadingExtrapolated, "READING_EXTRAPOLATED"},
      {map::taxel_flag::kCurvatureExtrapolated, "CURVATURE_EXTRAPOLATED"},
      {map::taxel_flag::kBetweenClasses, "BETWEEN_CLASSES"},
      {map::taxel_flag::kFilled, "FILLED"},
      {map::taxel_flag::kMasked, "MASKED"},
      {map::taxel_flag::kLineFault, "LINE_FAULT"},
      {map::taxel_flag::kTared, "TARED"},
      {map::taxel_flag::kBelowRange, "BELOW_RANGE"},
      {map::taxel_flag::kTemperatureExtrapolated, "TEMPERATURE_EXTRAPOLATED"},
      {map::taxel_flag::kHistoryShort, "HISTORY_SHORT"},
  }};
  std::string words;
  for (const auto& [bit, word] : kWords) {
    if ((flags & bit) != 0) words += (words.empty() ? "" : "|") + std::string(word);
  }
  return words.empty() ? "none" : words;
}

std::string stateWord(map::MapState state) {
  switch (state) {
    case map::MapState::kOk:
      return "OK";
    case map::MapState::kUncalibrated:
      return "UNCALIBRATED";
    case map::MapState::kCurvatureUnknown:
      return "CURVATURE_UNKNOWN";
    case map::MapState::kCurvatureStale:
      return "CURVATURE_STALE";
    case map::MapState::kSizeMismatch:
      return "SIZE_MISMATCH";
    case map::MapState::kWrongSensor:
      return "WRONG_SENSOR";
  }
  return "UNKNOWN";
}

}  // namespace fsr::exports
