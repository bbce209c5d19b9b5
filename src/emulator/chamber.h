#pragma once

#include <vector>

#include "fsr_pressure_map/simulation/chamber.h"
#include "simulation/pressure_profile.h"

namespace fsr::emulator {

/// The pressure chamber: at rest at first, then with the runs and stops that were commanded. All times are
/// rig time [s]. A command acts from its time on and never changes the past.
class Chamber {
 public:
  /// Starts a new run of cycles. A chamber under pressure is vented first.
  void startCycles(double time, const simulation::ChamberProtocol& protocol);

  /// Vents to rest at the rate of the last run.
  void stop(double time);

  /// Gauge pressure at any time so far [Pa].
  double gaugePressure(double time) const;

  /// End of the last run's cycles; infinite where they never end or were stopped.
  double cyclesEnd() const { return cycles_end_; }

 private:
  struct Section {
    double start;  // [s]
    simulation::PressureProfile profile;
  };
  double vent(double time);

  simulation::ChamberProtocol protocol_;
  std::vector<Section> sections_;  // by ascending start
  double cycles_end_ = 0;
};

}  // namespace fsr::emulator
