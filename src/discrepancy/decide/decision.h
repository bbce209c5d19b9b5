#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "discrepancy/decide/appraisal.h"
#include "discrepancy/decide/candidates.h"
#include "discrepancy/decide/refine.h"
#include "discrepancy/fit/cycle_noise.h"
#include "fsr_pressure_map/discrepancy/discrepancy.h"

namespace fsr::discrepancy {

/// Effect whose course is random, as far as the common trace tells it.
struct RandomFinding {
  simulation::EnabledEffect effect;
  std::vector<FittedParameter> parameters;  ///< the step first
  std::vector<std::string> partners;        ///< effects that the lack of evidence does not exclude
  Trace filtered;                           ///< the part of the common trace that belongs to it
  double z = 0;                             ///< mean of the nats that it adds by cycle, in standard errors
  double a_cycle = 0;  ///< step of the mean reading from one cycle to the next [share of full scale]
  bool alone = true;   ///< nothing else is left beyond chance
};

/// What is told of the preferred explanation, and of its rivals.
struct Preference {
  Refined refined;  ///< the preferred effects, fitted through the true forward model; empty where unknown
  std::vector<bool> bent_only;  ///< of each of them: acts only where the surface is bent
  std::vector<Refined> rivals;  ///< likewise, for the other credible explanations
  std::vector<std::vector<std::string>> credible;
  std::vector<std::string> depends_on;
  Trace explained;      ///< what the preferred explanation adds to the common trace, by its columns
  double z = 0;         ///< of the preferred explanation
  double closes = 0;    ///< share of what can be closed
  double at_map = NAN;  ///< see DiscrepancyReport::at_map [Pa]
  /// Of the preferred explanation and of each rival: predictive log density of each cycle [nats]. A rival
  /// that is credible because evidence is lacking has that of the preferred one.
  std::vector<std::vector<double>> densities;
};

/// Result of the comparison of explanations on the common trace.
struct Decision : Preference {
  Verdict verdict = Verdict::kNone;
  std::vector<Preference> others;  ///< the same with another member of the set preferred, the likelier first
  double p = 1;                    ///< probability of the best score if nothing were missing
  double least_gap = 0;            ///< [Pa]
  /// Where the verdict is none but for a random course. `p` and `at_map` are then those of the course.
  std::optional<RandomFinding> course;
  std::vector<CandidateScore> candidates;
  std::vector<CovariateTest> covariates;
  std::vector<SmallestSeen> smallest_seen;
  std::vector<TooSmall> too_small;
  std::vector<Scatter> scatter;
  std::vector<std::string> untested;     ///< effects that are credible because nothing tests them
  NoiseOfCycles noise;                   ///< fitted together with the preferred explanation
  std::vector<std::string> limitations;  ///< sentences
};

/// Effects that resemble another one and could not compete, because evidence that they need was not recorded:
/// nothing excludes them where the other one is found. None beside an effect that acts within a cycle alone.
std::vector<std::string> untestedBeside(const std::string& id, const Measured& measured,
                                        const Candidates& candidates,
                                        const simulation::SimulationSettings& base,
                                        const std::vector<std::string>& leave_out);

/// Returns the first verdict that holds, in the order none, unknown, ambiguous, wrong_form, named.
///
/// Explanations are compared by the predictive density of cycles that they were not fitted to. The preferred
/// one and its rivals are then fitted through the true forward model, because a large effect is not linear in
/// its strength.
Decision decide(const Measured& measured, const CommonTraces& common, const StaticFit& fit,
                const Candidates& candidates, const simulation::SimulationSettings& base,
                const DiscrepancyOptions& options);

}  // namespace fsr::discrepancy
