#include "ros/rviz/display_status.h"

#include <algorithm>
#include <map>
#include <utility>

#include "ros/messages/view_messages.h"

namespace fsr_rviz {

namespace {

using rviz::StatusProperty;

constexpr double kSilence = 2.0;  // time without a message after which the status reports it [s]

// " (reading, temperature)": what is extrapolated on the taxels of that look; empty without flags.
std::string extrapolatedText(const std::vector<fsr::view::TaxelLook>& looks,
                             const std::vector<std::uint16_t>& flags) {
  using namespace fsr::map::taxel_flag;
  std::uint16_t found = 0;
  for (std::size_t i = 0; i < std::min(looks.size(), flags.size()); ++i) {
    if (looks[i] == fsr::view::TaxelLook::kExtrapolated) found |= flags[i];
  }
  std::string text;
  for (const auto& [flag, word] :
       {std::pair{kReadingExtrapolated, "reading"}, std::pair{kCurvatureExtrapolated, "curvature"},
        std::pair{kTemperatureExtrapolated, "temperature"}}) {
    if ((found & flag) != 0) text += (text.empty() ? " (" : ", ") + std::string(word);
  }
  return text.empty() ? text : text + ")";
}

}  // namespace

StatusLine stateStatus(fsr::map::MapState state) {
  const std::string text = fsr_ros::stateText(state);
  switch (state) {
    case fsr::map::MapState::kOk:
      return {StatusProperty::Ok, "calibrated"};
    case fsr::map::MapState::kUncalibrated:
      return {StatusProperty::Error, text + "; load a calibration (calibration:=FILE or ~load_calibration)"};
    case fsr::map::MapState::kSizeMismatch:
      return {StatusProperty::Error, text + ": no pressure to show"};
    case fsr::map::MapState::kWrongSensor:
      return {StatusProperty::Error, text + ": the pressures are not valid"};
    default:
      return {StatusProperty::Warn, text};
  }
}

Flow flowOf(double seconds, double ros_seconds) {
  if (seconds < 0) return Flow::kNone;
  if (seconds < kSilence) return Flow::kComing;
  return ros_seconds < kSilence ? Flow::kPaused : Flow::kStopped;
}

std::string flowHeadline(Flow flow, const std::string& noun) {
  if (flow == Flow::kStopped) return "STOPPED: no more " + noun + "s";
  return flow == Flow::kPaused ? "PAUSED: the last " + noun : "";
}

std::string stateHeadline(fsr::map::MapState state) {
  switch (state) {
    case fsr::map::MapState::kOk:
      return "";
    case fsr::map::MapState::kUncalibrated:
      return "UNCALIBRATED";
    case fsr::map::MapState::kCurvatureUnknown:
      return "CURVATURE UNKNOWN";
    case fsr::map::MapState::kCurvatureStale:
      return "CURVATURE STALE";
    case fsr::map::MapState::kSizeMismatch:
      return "ANOTHER MATRIX SIZE";
    case fsr::map::MapState::kWrongSensor:
      return "ANOTHER SENSOR";
  }
  return "";
}

StatusLine messageStatus(Flow flow, double seconds, const std::string& noun, const std::string& topic) {
  if (topic.empty()) return {StatusProperty::Warn, "no topic is selected"};
  if (flow == Flow::kNone) return {StatusProperty::Warn, "no " + noun + " has come on " + topic};
  if (flow == Flow::kComing) return {StatusProperty::Ok, noun + "s are coming"};
  return {StatusProperty::Warn,
          "no " + noun + " for " + std::to_string(static_cast<long>(seconds)) + " s on " + topic +
              (flow == Flow::kPaused ? ", but the clock stands still: the last one is shown"
                                     : ": the sheet is grey")};
}

StatusLine curvatureStatus(const fsr::matrix::Surface& surface, const std::string& error,
                           const std::string& topic) {
  if (!error.empty()) return {StatusProperty::Error, error};
  if (!surface.known()) return {StatusProperty::Warn, "none on " + topic + ": the sheet is drawn flat"};
  return {StatusProperty::Ok, surface.name.empty() ? "received" : surface.name};
}

StatusLine taxelStatus(const std::vector<fsr::view::TaxelLook>& looks,
                       const std::vector<std::uint16_t>& flags) {
  std::map<fsr::view::TaxelLook, int> counts;
  for (const fsr::view::TaxelLook look : looks) ++counts[look];
  std::string text;
  for (const auto& [look, count] : counts) {
    if (look == fsr::view::TaxelLook::kGood || count == 0) continue;
    text += (text.empty() ? "" : ", ") + std::to_string(count) + " " + fsr::view::name(look);
    if (look == fsr::view::TaxelLook::kExtrapolated) text += extrapolatedText(looks, flags);
  }
  if (text.empty()) return {StatusProperty::Ok, "all readings are within range"};
  const bool harmless = counts[fsr::view::TaxelLook::kGood] + counts[fsr::view::TaxelLook::kBelowRange] ==
                        static_cast<int>(looks.size());
  return {harmless ? StatusProperty::Ok : StatusProperty::Warn, text};
}

}  // namespace fsr_rviz
