#pragma once

#include <fsr_pressure_map/SetAlarm.h>
#include <ros/node_handle.h>

#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "fsr_pressure_map/map/map_statistics.h"
#include "ros/live/view_settings.h"

namespace fsr_ros {

/// The alarms of the view node: which are set (`~alarm_threshold`, the region file and the service
/// `~set_alarm`), and the record of what they did. An alarm that is raised or ends is logged and published on
/// `events` as a note, so that a recording contains it. What the service sets is kept in the parameter
/// `~kept_alarms`, for a node that is started again after a crash.
class AlarmDesk {
 public:
  /// `changed` is called after the service has set an alarm.
  AlarmDesk(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle,
            const ViewSettings& settings, std::function<void()> changed);

  /// Whether an alarm is set, or may be by the region file, so that maps are needed in any case.
  bool any() const;
  /// The regions of the file, with their alarms; they are known from the first map on.
  void learn(const std::vector<fsr::map::Region>& regions);
  /// Sets the alarms of the parameter and of the service in `statistics`.
  void apply(fsr::map::MapStatistics& statistics) const;
  /// Logs and publishes the alarms that were raised or ended since the last call.
  void note(const std_msgs::Header& header, const std::vector<fsr::map::RegionStatistics>& regions);

 private:
  using Request = fsr_pressure_map::SetAlarm::Request;
  using Response = fsr_pressure_map::SetAlarm::Response;

  bool serve(Request& request, Response& response);
  std::string set(const Request& request);
  void keep() const;
  void takeKept(const std::string& kept);
  std::string text(double pressure) const;
  fsr::map::AlarmOptions present(const std::string& region) const;

  ros::NodeHandle private_handle_;
  std::string region_file_;
  fsr::settings::PressureUnit unit_;  // of pressures in sentences
  std::function<void()> changed_;
  bool known_ = false;                                  // the regions, with the first map
  std::map<std::string, fsr::map::AlarmOptions> file_;  // by region, as the region file sets them
  std::map<std::string, fsr::map::AlarmOptions> set_;   // by region, by parameter and service
  std::set<std::string> by_service_;                    // regions whose alarm the service has set
  std::map<std::string, fsr::map::AlarmState> states_;  // by region, at the last note()
  ros::Publisher events_;
  ros::ServiceServer service_;
};

}  // namespace fsr_ros
