#include "ros/live/alarm_desk.h"

#include <fsr_pressure_map/Event.h>

#include <algorithm>
#include <limits>
#include <sstream>
#include <utility>

#include "fsr_pressure_map/settings/input_error.h"
#include "ros/live/serve.h"
#include "settings/number_text.h"
#include "settings/text.h"

namespace fsr_ros {

namespace {

using fsr::map::AlarmOptions;
using fsr::map::AlarmState;

constexpr double kMaxThreshold = 10e6;  // [Pa]
constexpr double kMaxDwell = 3600;      // [s]

std::string nameOf(const std::string& region) {
  return region.empty() ? "the whole matrix" : "region " + region;
}

void require(const char* field, double value, double highest, const char* unit) {
  if (value >= 0 && value <= highest) return;  // false for NaN
  throw fsr::settings::InputError(std::string("set_alarm: ") + field + " is " +
                                  fsr::settings::numberText(value) + ", but must be 0 to " +
                                  fsr::settings::roundedText(highest, 6) + " " + unit);
}

}  // namespace

AlarmDesk::AlarmDesk(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle,
                     const ViewSettings& settings, std::function<void()> changed)
    : private_handle_(private_handle),
      region_file_(settings.regions),
      unit_(settings.style.scale.unit),
      changed_(std::move(changed)) {
  if (settings.alarm.used()) set_[""] = settings.alarm;
  takeKept(settings.kept_alarms);
  events_ = ros::NodeHandle(handle).advertise<fsr_pressure_map::Event>("events", 100);
  service_ = private_handle_.advertiseService("set_alarm", &AlarmDesk::serve, this);
}

std::string AlarmDesk::text(double pressure) const {
  return fsr::settings::roundedPressure(pressure, 4, unit_);
}

bool AlarmDesk::any() const {
  const auto used = [](const auto& entry) { return entry.second.used(); };
  if (std::any_of(set_.begin(), set_.end(), used)) return true;
  return known_ ? std::any_of(file_.begin(), file_.end(), used) : !region_file_.empty();
}

void AlarmDesk::learn(const std::vector<fsr::map::Region>& regions) {
  file_.clear();
  for (const fsr::map::Region& region : regions) file_[region.name] = region.alarm;
  known_ = true;
}

void AlarmDesk::apply(fsr::map::MapStatistics& statistics) const {
  for (const auto& [region, alarm] : set_) statistics.setAlarm(region, alarm);
}

AlarmOptions AlarmDesk::present(const std::string& region) const {
  if (const auto found = set_.find(region); found != set_.end()) return found->second;
  const auto found = file_.find(region);
  return found == file_.end() ? AlarmOptions() : found->second;
}

bool AlarmDesk::serve(Request& request, Response& response) {
  return answer(response, [&] { return set(request); });
}

std::string AlarmDesk::set(const Request& request) {
  const std::string name = nameOf(request.region);
  if (!request.region.empty() && file_.count(request.region) == 0) {
    throw fsr::settings::InputError(
        "set_alarm: there is no " + name + "; " +
        (known_ || region_file_.empty()
             ? "it must be a name of the region file (regions:=FILE), or empty for the whole matrix"
             : "the names of " + region_file_ + " are known from the first map on"));
  }
  require("threshold", request.threshold, kMaxThreshold, "Pa");
  AlarmOptions alarm = present(request.region);
  alarm.threshold = request.threshold > 0 ? request.threshold : std::numeric_limits<double>::infinity();
  if (!(request.dwell < 0)) alarm.dwell = request.dwell;
  if (!(request.hysteresis < 0)) alarm.hysteresis = request.hysteresis;
  require("dwell", alarm.dwell, kMaxDwell, "s");
  if (alarm.used()) require("hysteresis", alarm.hysteresis, alarm.threshold, "Pa");
  set_[request.region] = alarm;
  by_service_.insert(request.region);
  keep();
  changed_();
  if (!alarm.used()) return "no alarm is set for " + name;
  return "alarm of " + name + " at " + text(alarm.threshold) + " after " +
         fsr::settings::roundedText(alarm.dwell, 4) + " s, until below " +
         text(alarm.threshold - alarm.hysteresis);
}

// One line for each alarm that the service set: threshold [Pa], 0 = none; dwell [s]; hysteresis [Pa]; region.
void AlarmDesk::keep() const {
  std::ostringstream lines;
  lines.precision(std::numeric_limits<double>::max_digits10);
  for (const std::string& region : by_service_) {
    const AlarmOptions& alarm = set_.at(region);
    lines << (alarm.used() ? alarm.threshold : 0) << ' ' << alarm.dwell << ' ' << alarm.hysteresis << ' '
          << region << '\n';
  }
  private_handle_.setParam("kept_alarms", lines.str());
}

void AlarmDesk::takeKept(const std::string& kept) {
  std::istringstream lines(kept);
  std::string said;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    AlarmOptions alarm;
    std::string region;
    if (!(words >> alarm.threshold >> alarm.dwell >> alarm.hysteresis)) continue;
    std::getline(words.ignore(), region);
    if (!(alarm.threshold > 0)) alarm.threshold = std::numeric_limits<double>::infinity();
    set_[region] = alarm;
    by_service_.insert(region);
    said += (said.empty() ? "" : ", ") + (alarm.used() ? nameOf(region) + " at " + text(alarm.threshold)
                                                       : "no alarm for " + nameOf(region));
  }
  if (said.empty()) return;
  ROS_WARN_STREAM(private_handle_.getNamespace() << " goes on with the alarms that were set last: " << said);
}

void AlarmDesk::note(const std_msgs::Header& header, const std::vector<fsr::map::RegionStatistics>& regions) {
  for (const fsr::map::RegionStatistics& region : regions) {
    const AlarmState before = std::exchange(states_[region.region], region.alarm);
    const bool raised = region.alarm == AlarmState::kAlarm;
    if (raised == (before == AlarmState::kAlarm)) continue;
    std::string sentence = raised ? "ALARM: " + nameOf(region.region) + ", peak " +
                                        (region.at_least > 0 ? ">= " : "") + text(region.peak)
                                  : "alarm ended: " + nameOf(region.region) +
                                        (region.alarm == AlarmState::kUnknown ? ", now unknown" : "");
    ROS_WARN_STREAM(private_handle_.getNamespace() << ": " << sentence);
    fsr_pressure_map::Event event;
    event.header = header;
    event.kind = "note";
    event.label = std::move(sentence);
    events_.publish(event);
  }
}

}  // namespace fsr_ros
