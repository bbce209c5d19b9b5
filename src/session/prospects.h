#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "session/plan.h"

namespace fsr::session {

/// An effect that `discrepancy` could not name alone.
struct UntoldEffect {
  std::string id;
  std::string reason;    ///< one sentence
  bool by_plan = false;  ///< another plan for the same chamber could tell it
};

/// What the recordings of a session could tell. Nothing here is an estimate of how well: that depends on the
/// sheet.
struct Prospects {
  std::string training;     ///< why `train` would refuse the recordings; empty = it accepts them
  std::string discrepancy;  ///< why `discrepancy` would refuse them; empty = it accepts them

  std::vector<std::string> told;     ///< ids of effects that `discrepancy` could name alone
  std::vector<UntoldEffect> untold;  ///< the others of its library
  std::size_t hold_out = 0;          ///< cycles that `discrepancy` holds out
  std::size_t fewest_cycles = 0;     ///< on a surface, over all of its mounts

  std::vector<double> curvatures;  ///< of the surfaces, ascending [1/m]
  double highest = 0;              ///< largest pressure of the recordings [Pa]
  std::size_t mounts = 0;
  std::size_t remounted = 0;  ///< surfaces that are mounted twice or more
  bool first_again = false;   ///< the first surface is also the last, and another one was between
  bool conditioned = false;
  bool temperature = false;  ///< is recorded

  std::vector<std::string> protocols;  ///< names, by which the cycles differ
  bool history = false;                ///< a protocol can be left out, so that `train` may learn a memory
  double longest_memory = 0;           ///< that could be learned [s]; 0 = none
  bool tare = false;                   ///< a session can be left out, so that `train` may expect a tare

  /// Largest share that conformal intervals of these mounts can cover: n / (n + 1).
  double coverage() const { return double(mounts) / double(mounts + 1); }
  /// Surfaces between the two outermost: each is left out in turn, which gives the error between surfaces.
  std::size_t inner() const { return curvatures.size() > 2 ? curvatures.size() - 2 : 0; }
};

/// Runs the plan with one simulated taxel, and asks the functions of `train` and `discrepancy` what these
/// recordings contain. The plan must be valid.
Prospects prospectsOf(const SessionPlan& plan);

}  // namespace fsr::session
