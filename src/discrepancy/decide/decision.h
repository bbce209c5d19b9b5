#pragma once

#include <string>
#include <vector>

#include "discrepancy/decide/candidates.h"
#include "discrepancy/decide/refine.h"
#include "discrepancy/fit/taxel_fit.h"
#include "fsr_pressure_map/discrepancy/discrepancy.h"

namespace fsr::discrepancy {

/// What the common trace says.
struct Decision {
  Verdict verdict = Verdict::kNone;
  Score explanation;            ///< put forward; where it is unknown, by generic terms
  Refined refined;              ///< the same through the true forward model; empty where it is unknown
  std::vector<Refined> rivals;  ///< likewise, of the other credible explanations
  std::vector<std::vector<std::string>> credible;
  std::vector<std::string> depends_on;
  double explainable = 0;     ///< share of the common trace's error that anything explains
  double share = 0;           ///< that the explanation does
  double share_of_error = 0;  ///< of the readings' squared error
  double z = 0;
  std::string reason;  ///< one sentence
  std::vector<CandidateScore> candidates;
};

/// The first verdict that holds, of: none, unknown, ambiguous, wrong_form, named.
///
/// Effects are compared by what their signatures explain of cycles that took no part; those that come
/// near the best once more through the true forward model, because a large effect bends.
Decision decide(const Measured& measured, const CommonTraces& common, const StaticFit& fit,
                const TaxelFit& taxels, const Candidates& candidates,
                const simulation::SimulationSettings& base);

}  // namespace fsr::discrepancy
