#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/node_handle.h>

#include <atomic>
#include <memory>
#include <string>
#include <vector>

#include "ros/bags/bag_sink.h"

namespace fsr_ros {

/// Records topics of any type into one bag, as `rosbag record` does, for streams that nothing may be missing
/// from: each topic may be ten seconds at 1 kHz behind before a message is lost (rosbag: a tenth of a
/// second), a full disk leaves a closed bag, and an older recording is never overwritten. Diagnostics say
/// what was written and what was lost. Ends ROS, with a sentence, where it can record no more.
///
/// Parameters: `~bag`, `~topics` (names, separated by spaces), `~chunk_kb`, `~min_space` [MB], `~buffer`
/// [MB].
class Recorder {
 public:
  /// Throws fsr::InputError.
  Recorder(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle);

  /// Whether it ended by itself.
  bool failed() const { return failed_; }

 private:
  void subscribe(const std::string& topic);
  void judge(diagnostic_updater::DiagnosticStatusWrapper& status);

  ros::NodeHandle handle_;
  std::atomic<bool> failed_{false};
  std::atomic<std::uint64_t> without_time_{0};  // messages before /clock
  std::unique_ptr<BagSink> sink_;
  diagnostic_updater::Updater diagnostics_;
  BagSinkReport before_;
  std::vector<ros::Subscriber> subscribers_;
  ros::WallTimer timer_;
};

}  // namespace fsr_ros
