#include "ros/live/view_settings.h"

#include <ros/console.h>

#include "ros/bags/resource_path.h"
#include "ros/live/parameters.h"

namespace fsr_ros {

namespace {

constexpr double kMaxPressure = 10e6;  // [Pa]

fsr::view::PressureScale scaleOf(const Parameters& parameters) {
  fsr::view::PressureScale scale;
  scale.low = parameters.number("range_low", scale.low, {-kMaxPressure, kMaxPressure, "Pa"});
  scale.high = parameters.number("range_high", scale.high, {-kMaxPressure, kMaxPressure, "Pa"});
  scale.unit = fsr::view::pressureUnitOf(parameters.choice("unit", fsr::view::pressureUnitNames(), "kPa"));
  scale.colours =
      fsr::view::colourMapOf(parameters.choice("colour_map", fsr::view::colourMapNames(), "viridis"));
  if (!(scale.low < scale.high)) {
    throw parameters.error("range_high", "must be above range_low, " + std::to_string(scale.low) + " Pa");
  }
  return scale;
}

fsr::view::HeatMapStyle styleOf(const Parameters& parameters) {
  fsr::view::HeatMapStyle style;
  style.scale = scaleOf(parameters);
  style.layer = parameters.choice("layer", {"pressure", "deviation"}, "pressure") == "pressure"
                    ? fsr::view::MapLayer::kPressure
                    : fsr::view::MapLayer::kDeviation;
  style.smooth = parameters.choice("style", {"smooth", "cells"}, "smooth") == "smooth";
  style.longer_side =
      static_cast<int>(parameters.integer("image_size", style.longer_side, {64, 4096, "pixels"}));
  return style;
}

fsr::map::AlarmOptions alarmOf(const Parameters& parameters) {
  fsr::map::AlarmOptions alarm;
  const double threshold = parameters.number("alarm_threshold", 0, {0, kMaxPressure, "Pa"});
  alarm.dwell = parameters.number("alarm_dwell", alarm.dwell, {0, 3600, "s"});
  alarm.hysteresis = parameters.number("alarm_hysteresis", alarm.hysteresis, {0, kMaxPressure, "Pa"});
  if (!(threshold > 0)) return alarm;
  if (alarm.hysteresis > threshold) {
    throw parameters.error("alarm_hysteresis",
                           "must not be above alarm_threshold, " + std::to_string(threshold) + " Pa");
  }
  alarm.threshold = threshold;
  return alarm;
}

}  // namespace

ViewSettings::ViewSettings(const ros::NodeHandle& private_handle) {
  const Parameters parameters(private_handle);
  queue_size = static_cast<std::uint32_t>(parameters.integer("queue_size", 10, {1, 100000, "messages"}));
  style = styleOf(parameters);
  auto_range = parameters.flag("auto_range", false);
  fineness = static_cast<int>(parameters.integer("fineness", 3, {1, 16}));
  rate = parameters.number("rate", 20, {0.1, 1000, "Hz"});
  contact_threshold = parameters.number("contact_threshold", 10e3, {0, kMaxPressure, "Pa"});
  regions = resolveLaunchPath(parameters.text("regions", ""));
  alarm = alarmOf(parameters);
  kept_alarms = parameters.text("kept_alarms", "");
  stale_after = parameters.number("stale_after", 1.0, {0.05, 3600, "s"});
  parameters.warnOfUnknown("view node");
}

}  // namespace fsr_ros
