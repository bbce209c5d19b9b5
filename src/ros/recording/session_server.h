#pragma once

#include <diagnostic_updater/DiagnosticStatusWrapper.h>
#include <fsr_pressure_map/Session.h>
#include <ros/node_handle.h>

#include <cstdint>
#include <optional>
#include <string>

namespace fsr_ros {

/// A sample of the state of a bag that is being written.
struct RecordingLook {
  std::string file;         ///< FILE.bag.active, or FILE.bag after it is closed; empty = neither exists
  std::uint64_t size = 0;   ///< [bytes]
  std::uint64_t space = 0;  ///< space left on its disk [bytes]
};

/// `bag`: path of the recording, with or without .bag.
RecordingLook lookAtRecording(const std::string& bag);

/// Checks from outside whether the file of a recording grows. A recorder that was killed or hangs cannot
/// report that itself, and `rosbag record` stops writing without ending when the disk is nearly full.
class RecordingWatch {
 public:
  /// `least_space`: recording stops when less space is left [bytes]. `patience`: time without growth after
  /// which diagnostics report an error [s].
  RecordingWatch(std::uint64_t least_space, double patience)
      : least_space_(least_space), patience_(patience) {}

  /// Diagnostics of a sample taken at `time` (monotonic clock [s]).
  void judge(const RecordingLook& look, double time, diagnostic_updater::DiagnosticStatusWrapper& status);

 private:
  struct Growth {
    std::uint64_t size;
    double time;  // at which the file was first seen with this size [s]
  };

  void noteGrowth(std::uint64_t size, double time);

  std::uint64_t least_space_;
  double patience_;
  std::optional<Growth> first_;
  std::optional<Growth> last_;
};

/// Reads the description of a recording from the parameters of a session node, whose namespace is that of
/// `session_node`. Throws fsr::InputError.
fsr_pressure_map::Session readSession(const ros::NodeHandle& session_node);

}  // namespace fsr_ros
