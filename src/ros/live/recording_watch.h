#pragma once

#include <diagnostic_updater/DiagnosticStatusWrapper.h>

#include <cstdint>
#include <optional>
#include <string>

namespace fsr_ros {

/// A bag that is being written, at one moment.
struct RecordingLook {
  std::string file;         ///< FILE.bag.active, or FILE.bag once it is closed; empty = neither is there
  std::uint64_t size = 0;   ///< [bytes]
  std::uint64_t space = 0;  ///< that its disk has left [bytes]
};

/// `bag`: the path that the recorder was given, with or without .bag.
RecordingLook lookAtRecording(const std::string& bag);

/// Sees from outside whether a recording goes on: a recorder that was killed or hangs cannot say so itself,
/// and `rosbag record` stops writing without ending where the disk is nearly full.
class RecordingWatch {
 public:
  /// `least_space`: below it recording stops [bytes]. `patience`: how long a bag may stay the same size [s].
  RecordingWatch(std::uint64_t least_space, double patience)
      : least_space_(least_space), patience_(patience) {}

  /// Diagnostics of what is seen at `time` [s, steady].
  void judge(const RecordingLook& look, double time, diagnostic_updater::DiagnosticStatusWrapper& status);

 private:
  struct Growth {
    std::uint64_t size;
    double time;  // at which it was first seen that large [s]
  };

  void noteGrowth(std::uint64_t size, double time);

  std::uint64_t least_space_;
  double patience_;
  std::optional<Growth> first_;
  std::optional<Growth> last_;
};

}  // namespace fsr_ros
