#pragma once

#include <fsr_pressure_map/Mark.h>
#include <fsr_pressure_map/Session.h>
#include <ros/node_handle.h>

namespace fsr_ros {

/// Publishes what a recording is about, so that a bag can be understood alone: `session`, latched and
/// repeated each second, from the private parameters named as the fields of Session.msg; and
/// `events`, one for each call of `~mark`.
///
/// Persons appear by code only: `~subject_code` must match [A-Z]{1,3}[0-9]{2,4}.
class SessionServer {
 public:
  /// Throws fsr::InputError.
  SessionServer(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle);

 private:
  bool mark(fsr_pressure_map::Mark::Request& request, fsr_pressure_map::Mark::Response& response);
  void publish();

  ros::NodeHandle handle_;
  fsr_pressure_map::Session session_;
  ros::Publisher session_publisher_;
  ros::Publisher event_publisher_;
  ros::ServiceServer service_;
  ros::Timer timer_;
};

}  // namespace fsr_ros
