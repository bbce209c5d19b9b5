#pragma once

#include <vector>

#include "fsr_pressure_map/simulation/chamber.h"

namespace fsr::simulation {

/// A point of a pressure profile: gauge pressure [Pa] at a time [s].
struct PressurePoint {
  double time = 0;
  double pressure = 0;
};

/// Gauge pressure over time, linear between its points: ramps, steps, dwells and repeated cycles, one part
/// after another. It is a pure function of time and does not depend on the scan rate.
class PressureProfile {
 public:
  /// Appends a part. The times of its points count from the part's start, ascending from 0; the last
  /// one is the part's length. The part runs `repeats` times, 0 = for ever.
  /// Throws std::invalid_argument, also where a part follows one that never ends.
  void append(const std::vector<PressurePoint>& points, unsigned repeats = 1);

  /// Gauge pressure [Pa] at `time` [s] since the profile's start: the first point's before, the last
  /// one's after it, 0 for a profile without parts.
  double at(double time) const;

  /// Length of the whole [s]; infinite where a part repeats for ever.
  double duration() const;
  bool empty() const { return parts_.empty(); }

 private:
  struct Part {
    double start = 0;   // [s] since the profile's start
    double period = 0;  // [s]
    double end = 0;     // [s], infinite where it repeats for ever
    std::vector<PressurePoint> points;
  };
  std::vector<Part> parts_;
};

/// One cycle, from its start.
std::vector<PressurePoint> cyclePoints(const ChamberProtocol& protocol);
PressureProfile pressureProfile(const ChamberProtocol& protocol);
PressureProfile pressureProfile(const ChamberProgram& program);

/// Linear from `pressure` down to 0 at the protocol's venting rate.
PressureProfile ventingProfile(const ChamberProtocol& protocol, double pressure);

}  // namespace fsr::simulation
