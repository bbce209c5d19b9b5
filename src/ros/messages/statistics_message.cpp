#include "ros/messages/statistics_message.h"

#include <algorithm>
#include <limits>

namespace fsr_ros {

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

}  // namespace

fsr_pressure_map::PressureStatistics toMessage(const fsr::map::RegionStatistics& statistics,
                                               const fsr::matrix::Layout& layout) {
  fsr_pressure_map::PressureStatistics message;
  message.region = statistics.region;
  message.peak = statistics.peak;
  message.mean = statistics.mean;
  message.standard_deviation = statistics.standard_deviation;
  message.contact_area = statistics.contact_area;
  message.total_area = statistics.total_area;
  message.force = statistics.force;
  message.pressure_time_integral = statistics.pressure_time_integral;
  message.duration = statistics.duration;
  if (layout.size.taxels() > 0) {
    message.peak_row = layout.row(statistics.peak_taxel);
    message.peak_column = layout.column(statistics.peak_taxel);
  }
  message.bad = static_cast<std::uint16_t>(std::min<std::size_t>(statistics.bad, 65535));
  message.saturated = static_cast<std::uint16_t>(std::min<std::size_t>(statistics.at_least, 65535));
  message.centre.x = statistics.centre ? statistics.centre->x : kNone;
  message.centre.y = statistics.centre ? statistics.centre->y : kNone;
  message.centre.z = statistics.centre ? 0 : kNone;
  message.alarm = static_cast<std::uint8_t>(statistics.alarm);
  return message;
}

fsr::map::RegionStatistics toStatistics(const fsr_pressure_map::PressureStatistics& message) {
  using Message = fsr_pressure_map::PressureStatistics;
  using fsr::map::AlarmState;
  static_assert(static_cast<std::uint8_t>(AlarmState::kOk) == Message::OK);
  static_assert(static_cast<std::uint8_t>(AlarmState::kAlarm) == Message::ALARM);
  static_assert(static_cast<std::uint8_t>(AlarmState::kUnknown) == Message::UNKNOWN);
  fsr::map::RegionStatistics statistics;
  statistics.region = message.region;
  statistics.peak = message.peak;
  statistics.mean = message.mean;
  statistics.standard_deviation = message.standard_deviation;
  statistics.contact_area = message.contact_area;
  statistics.total_area = message.total_area;
  statistics.force = message.force;
  statistics.pressure_time_integral = message.pressure_time_integral;
  statistics.duration = message.duration;
  statistics.bad = message.bad;
  statistics.at_least = message.saturated;
  const bool known = message.alarm <= static_cast<std::uint8_t>(AlarmState::kNotSet);
  statistics.alarm = known ? static_cast<AlarmState>(message.alarm) : AlarmState::kUnknown;
  return statistics;
}

}  // namespace fsr_ros
