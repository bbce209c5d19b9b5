#pragma once

#include <ros/ros.h>

#include <cstdint>
#include <mutex>
#include <string>
#include <vector>

#include "dataset/recording_builder.h"
#include "fsr_pressure_map/calibration/calibration.h"

namespace fsr_ros {

/// Collects messages from the topics raw, chamber_pressure, curvature, temperature and matrix_info, sent by
/// `rosbag play` or a rig. The service `~train` trains a calibration from them, and `~clear` removes them. If
/// one bag was replayed without loss, the tables are those of the tool `train`, bit for bit.
///
/// Training runs in the thread of the service call. With two or more spinner threads, the node goes on
/// collecting meanwhile. From `~most_messages` on, further messages are left out. `~gathered`
/// (diagnostic_msgs/DiagnosticStatus, latched) reports what has come and what is missing.
///
/// Parameters: ~output, ~report, ~scheme, ~model, ~bandwidth, ~spread, ~distance, ~equal_bins, ~trees,
/// ~minimum_leaf, ~leaf_rule, ~folds, ~scores, ~threads, ~seed, ~ambient_pressure, ~most_messages; see
/// train.launch and docs/nodes.md.
class TrainingServer {
 public:
  /// Throws fsr::InputError.
  TrainingServer(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle);

 private:
  template <typename Message>
  void subscribe(const std::string& topic);
  template <typename Message>
  void gather(const Message& message);
  std::string train();
  std::string clear();
  fsr::dataset::Recording gatheredRecording();
  void publishGathered();

  ros::NodeHandle handle_;
  std::string output_, report_;
  fsr::calibration::CalibrationOptions options_;
  fsr::dataset::RecordingOptions recording_options_;

  std::uint64_t most_ = 0;  // messages that are gathered

  std::mutex gathering_;  // guards builder_, copying_ and refused_
  fsr::dataset::RecordingBuilder builder_;
  bool copying_ = false;       // what was gathered; builder_ has what has come since
  std::uint64_t refused_ = 0;  // messages
  std::mutex training_;        // held during a training: one at a time

  std::vector<ros::Subscriber> subscribers_;
  ros::Publisher gathered_;
  std::vector<ros::ServiceServer> services_;
  ros::WallTimer timer_;
  std::string last_gathered_;
};

}  // namespace fsr_ros
