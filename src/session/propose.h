#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "session/plan.h"

namespace fsr::session {

/// What a session is wanted for, and what there is.
struct PlanRequest {
  Purpose purpose = Purpose::kPerCurvature;
  double time = 0;                                    ///< that there is [s]
  std::vector<matrix::Surface> surfaces;              ///< at least one
  double peak = 620e3;                                ///< largest pressure to measure, gauge [Pa]
  double chamber_limit = simulation::kChamberRating;  ///< [Pa]
  double change = 180;                                ///< to put the sheet on the next surface [s]
  bool thermometer = false;
  std::uint64_t seed = 1;
  matrix::MatrixSize matrix{7, 10};
};

struct ProposedPlan {
  SessionPlan plan;
  SessionPlan whole;  ///< the plan for this purpose and these surfaces without a limit of time
};

/// Makes a plan for a purpose: of the sizes in its table (propose.cpp) the first that fits the time. Throws
/// InputError where not even one cycle fits, and where the conditioning would pass the chamber's limit.
/// Messages name the options of the tool plan_session.
ProposedPlan proposePlan(const PlanRequest& request);

}  // namespace fsr::session
