#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <fsr_pressure_map/Mark.h>
#include <fsr_pressure_map/Session.h>
#include <ros/node_handle.h>

#include <memory>
#include <string>

#include "ros/live/recording_watch.h"

namespace fsr_ros {

/// Publishes what a recording is about, so that a bag can be understood alone: `session`, latched and
/// repeated each second, from the private parameters named as the fields of Session.msg; and
/// `events`, one for each call of `~mark`.
///
/// Where `~bag` names the bag that is being recorded, `/diagnostics` and the log say whether it grows.
///
/// Persons appear by code only: `~subject_code` must match [A-Z]{1,3}[0-9]{2,4}.
class SessionServer {
 public:
  /// Throws fsr::InputError.
  SessionServer(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle);

 private:
  bool mark(fsr_pressure_map::Mark::Request& request, fsr_pressure_map::Mark::Response& response);
  void publish();
  void watchRecording(const std::string& bag, double least_space);
  void judgeRecording(const std::string& bag, diagnostic_updater::DiagnosticStatusWrapper& status);

  ros::NodeHandle handle_;
  fsr_pressure_map::Session session_;
  ros::Publisher session_publisher_;
  ros::Publisher event_publisher_;
  ros::ServiceServer service_;
  ros::Timer timer_;
  std::unique_ptr<RecordingWatch> recording_;
  std::unique_ptr<diagnostic_updater::Updater> diagnostics_;
  ros::WallTimer recording_timer_;
};

}  // namespace fsr_ros
