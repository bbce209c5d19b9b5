#pragma once

#include <string>
#include <vector>

#include "fsr_pressure_map/simulation/simulation_settings.h"
#include "session/plan.h"

namespace fsr::session {

/// One stay of the sheet on a surface. It becomes one bag.
struct PlannedMount {
  unsigned number = 1;      ///< label of the mount and number of the bag, from 1
  std::size_t surface = 0;  ///< index into SessionPlan::surfaces
};

/// The mounts in their order. They come in rounds: each surface once, then those with a further mount once
/// more, so that surface and time are not the same thing. In a drawn order the first surface of
/// the plan stays the first one, everything behind it is drawn by the seed, and no surface follows itself
/// unless it is the only one left.
std::vector<PlannedMount> mountOrder(const SessionPlan& plan);

/// The numbers are those of msg/Instruction.msg.
enum class StepKind {
  kCondition,  ///< one cycle of the conditioning
  kMount,      ///< put the sheet on a surface
  kRest,       ///< no load
  kCycle,      ///< fill, dwell, vent
  kLoop,       ///< a partial loop from `low` to `peak` and back
  kHold,       ///< a pressure is held
  kBreak,      ///< a long pause without load, which is not recorded
  kDone,       ///< no step: the session is over
};

/// "condition", "mount", "rest", "cycle", "loop", "hold", "break", "done".
std::string name(StepKind kind);

/// One thing to do, and what the chamber should then show. Pressures and times that a kind does not have are
/// 0.
struct SessionStep {
  StepKind kind = StepKind::kMount;
  unsigned mount = 1;      ///< label of the mount
  std::string surface;     ///< its name
  bool recorded = false;   ///< whether it belongs into the bag of the mount
  double begin = 0;        ///< since the begin of the session [s]
  double duration = 0;     ///< from the end of the step before it [s]
  double low = 0;          ///< of a loop, gauge [Pa]
  double peak = 0;         ///< of a cycle or loop, or the pressure that is held, gauge [Pa]
  double fill_rate = 0;    ///< [Pa/s]
  double vent_rate = 0;    ///< [Pa/s]
  double dwell_peak = 0;   ///< at `peak` [s]
  double dwell_rest = 0;   ///< without load before a cycle, or the length of a rest or break [s]
  unsigned number = 1;     ///< of this kind on this mount, from 1
  unsigned of = 1;         ///< how many of this kind there are on this mount
  double peak_error = 0;   ///< tolerated difference of the peak [Pa]
  double rate_error = 0;   ///< likewise of the rates, share
  double dwell_error = 0;  ///< likewise of the dwells [s]

  /// Whether the chamber is filled.
  bool loads() const {
    return kind == StepKind::kCondition || kind == StepKind::kCycle || kind == StepKind::kLoop ||
           kind == StepKind::kHold;
  }
};

/// All steps of the session in their order, without gaps. The plan must be valid, see validate().
std::vector<SessionStep> sessionSteps(const SessionPlan& plan);

/// What an operator is told, e.g. "Cycle 3 of 10: fill to 620 kPa at 17 kPa/s, hold for 1 s, vent at 17
/// kPa/s."
std::string instruction(const SessionStep& step);

/// Length of the session [s], and of the recording of one mount [s].
double sessionDuration(const SessionPlan& plan);
double recordingDuration(const SessionPlan& plan);

/// The recorded part of the session for simulation::simulateSession(). The conditioning is left out; its time
/// is a pause.
std::vector<simulation::Station> simulatedStations(const SessionPlan& plan);

}  // namespace fsr::session
