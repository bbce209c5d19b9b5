#pragma once

#include <fsr_pressure_map/PressureStatisticsArray.h>
#include <ros/node_handle.h>

#include <string>
#include <vector>

namespace fsr_ros {

/// Several sheets round one limb as one: sums the `statistics` of `~sheets` (topics, with spaces or commas
/// between) region by region name and publishes `limb_statistics` for every message of any sheet. A sheet
/// that is silent for `~stale_after` [s] adds no numbers and makes every alarm UNKNOWN.
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
  bool speaks(const Sheet& sheet) const;

  ros::NodeHandle handle_;
  double stale_after_;  // [s]
  std::vector<Sheet> sheets_;
  ros::Publisher sum_;
  ros::WallTimer silence_;
};

}  // namespace fsr_ros
