#pragma once

#include <cstdint>
#include <tuple>

#include "session/conductor.h"
#include "simulation/pressure_profile.h"

namespace fsr::session {

/// What a regulator should set, for rigs that have one: the present step as a course of pressure, which
/// begins where the last one was left. Vents where a person is asked, behind a rejected attempt, and while
/// the transducer gives no reading or the pressure is above the limit of the chamber.
class ChamberCommand {
 public:
  /// Pressure to set at `time`, gauge [Pa]. Call it at each reading, in the order of time [s].
  double next(const Conductor& conductor, double time);

 private:
  using Key = std::tuple<std::size_t, bool, std::uint64_t>;  // step, whether it is done, attempts so far

  void plan(const SessionStep* step);

  Key key_{~std::size_t{0}, false, 0};
  double begin_ = 0;  // of the course [s]
  double set_ = 0;    // last answer [Pa]
  simulation::PressureProfile profile_;
};

}  // namespace fsr::session
