#pragma once

#include <vector>

#include "simulation/pressure_profile.h"

namespace fsr::emulator {

/// Gauge pressure over rig time that is written piece by piece while it is read: linear between its points,
/// 0 before the first one, constant after the last one.
class PressureCourse {
 public:
  /// Forgets everything from `time` [s] on. The pressure of that time stays. Times before it do not change.
  void cut(double time);
  /// Appends a straight piece to `pressure` [Pa gauge], at `rate` [Pa/s] or within `duration` [s].
  void rampTo(double pressure, double rate);
  void moveTo(double pressure, double duration);
  /// Appends a piece of constant pressure [s].
  void stay(double duration) { moveTo(pressure(), duration); }

  /// End of what is written [s] and the pressure there [Pa].
  double end() const { return points_.back().time; }
  double pressure() const { return points_.back().pressure; }
  /// Pressure at any time [Pa].
  double at(double time) const;

 private:
  std::vector<simulation::PressurePoint> points_{{0, 0}};  // by ascending time
};

}  // namespace fsr::emulator
