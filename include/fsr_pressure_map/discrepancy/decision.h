#pragma once

#include <string>
#include <vector>

#include "fsr_pressure_map/discrepancy/competition.h"
#include "fsr_pressure_map/discrepancy/discrepancy.h"
#include "fsr_pressure_map/discrepancy/refine.h"
#include "fsr_pressure_map/discrepancy/taxel_fit.h"

namespace fsr {

/// What the common trace says.
struct Decision {
  Verdict verdict = Verdict::kNone;
  Score explanation;            ///< put forward; where it is unknown, by generic terms
  Refined refined;              ///< the same through the true forward model; empty where it is unknown
  std::vector<Refined> rivals;  ///< likewise, of the other credible explanations
  std::vector<std::vector<std::string>> credible;
  std::vector<std::string> depends_on;
  double ceiling = 0;         ///< share of the common trace's error that anything explains
  double share = 0;           ///< that the explanation does
  double share_of_error = 0;  ///< of the readings' squared error
  double z = 0;
  std::string reason;  ///< one sentence
  std::vector<CandidateScore> candidates;
};

/// What the recordings hold, for effects that must not be named without it.
struct EvidenceAtHand {
  bool thermometer = false;
  bool two_rates = false;  ///< or dwells
  bool mount_labels = false;
  bool remounted = false;      ///< some surface was mounted twice
  bool uneven_pace = false;    ///< cycles in plenty at some time and none for hours at another
  bool uneven_warmth = false;  ///< the temperature went another way than the clock, over hours
  bool has(Evidence evidence) const;
};
EvidenceAtHand evidenceIn(const Measured& measured);

/// The first verdict that holds, of: none, unknown, ambiguous, wrong_form, named.
///
/// Effects are compared by what their signatures explain of cycles that took no part; those that come
/// near the best once more through the true forward model, because a large effect bends.
Decision decide(const Measured& measured, const CommonTraces& common, const StaticFit& fit,
                const TaxelFit& taxels, const Competition& competition, const SimulationSettings& base);

}  // namespace fsr
