#pragma once

#include <fsr_pressure_map/PressureStatisticsArray.h>
#include <ros/node_handle.h>

#include <string>
#include <vector>

namespace fsr_ros {

/// Combines the statistics of several sheets round one limb. Sums the topics in `~sheets` (separated by
/// spaces or commas) by region name, and publishes `limb_statistics` for every message of any sheet. A sheet
/// without a message for `~stale_after` [s] is left out of the sums, and every alarm that is not ALARM
/// becomes UNKNOWN.
class LimbServer {
 public:
  /// Throws fsr::InputError.
  LimbServer(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle);

 private:
  struct Sheet {
    fsr_pressure_map::PressureStatisticsArrayConstPtr last;
    ros::WallTime received;
    ros::Subscriber subscriber;
  };
  void publish();
  bool isHeard(const Sheet& sheet) const;

  ros::NodeHandle handle_;
  double stale_after_;  // [s]
  std::vector<Sheet> sheets_;
  ros::Publisher sum_;
  ros::WallTimer silence_;
};

}  // namespace fsr_ros
