#pragma once

#include <chrono>

namespace fsr::emulator {

/// Rig time [s]: wall time of the monotonic clock since the start, times a scale. This is an absolute
/// schedule: it does not drift where a thread wakes late.
class RigSchedule {
 public:
  using WallClock = std::chrono::steady_clock;

  /// Rig time 0 is now. `scale`: seconds of rig time per second.
  explicit RigSchedule(double scale) : scale_(scale), origin_(WallClock::now()) {}

  double now() const { return std::chrono::duration<double>(WallClock::now() - origin_).count() * scale_; }

  WallClock::time_point wallTime(double rig_time) const {
    const std::chrono::duration<double> since_origin(rig_time / scale_);
    return origin_ + std::chrono::duration_cast<WallClock::duration>(since_origin);
  }

  bool realTime() const { return scale_ == 1; }

  /// Stops rig time for this duration.
  void hold(WallClock::duration duration) { origin_ += duration; }

 private:
  double scale_;
  WallClock::time_point origin_;
};

}  // namespace fsr::emulator
