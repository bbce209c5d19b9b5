#pragma once

#include <string>
#include <vector>

#include "discrepancy/decide/candidates.h"
#include "discrepancy/decide/refine.h"
#include "discrepancy/fit/taxel_fit.h"
#include "fsr_pressure_map/discrepancy/discrepancy.h"

namespace fsr::discrepancy {

/// Result of the comparison of explanations on the common trace.
struct Decision {
  Verdict verdict = Verdict::kNone;
  Score explanation;  ///< the preferred one; generic terms where the verdict is unknown
  Refined refined;    ///< the same, fitted through the true forward model; empty where the verdict is unknown
  std::vector<Refined> rivals;  ///< likewise, for the other credible explanations
  std::vector<std::vector<std::string>> credible;
  std::vector<std::string> depends_on;
  double explainable = 0;     ///< share of the common trace's error that is explainable
  double share = 0;           ///< share that the explanation explains
  double share_of_error = 0;  ///< share of the readings' squared error
  double z = 0;
  std::string reason;  ///< one sentence
  std::vector<CandidateScore> candidates;
};

/// Returns the first verdict that holds, in the order none, unknown, ambiguous, wrong_form, named.
///
/// Effects are compared by what their signatures explain in cycles that they were not fitted to. Effects that
/// come near the best one are compared again through the true forward model, because a large effect is not
/// linear in its strength.
Decision decide(const Measured& measured, const CommonTraces& common, const StaticFit& fit,
                const TaxelFit& taxels, const Candidates& candidates,
                const simulation::SimulationSettings& base);

}  // namespace fsr::discrepancy
