#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "discrepancy/decide/held_out_scores.h"
#include "fsr_pressure_map/discrepancy/discrepancy.h"

namespace fsr::discrepancy {

/// The single column by which an effect acts best, as a start for a fit through the forward model.
struct SingleColumn {
  Eigen::Index column = 0;
  double coefficient = 0;
  bool bent_only = false;
};

/// An explanation, weighed against the others.
struct Weighed {
  Explaining explaining;
  double p_alone =
      1;         ///< probability of its score if nothing were missing, without correction for the search
  double p = 1;  ///< the same, corrected for the search
  bool contends = false;        ///< weighed under a noise of its own; false = too far behind the best
  std::vector<double> density;  ///< of each cycle: predictive log density [nats]
  double total = 0;   ///< nats that it adds to the predictive density of cycles that it was not fitted to
  double z = 0;       ///< mean of what it adds by cycle, in standard errors
  double closes = 0;  ///< share of the closable whitened loss that it closes in held-out cycles
  double at_map =
      0;  ///< rms of what it explains beyond the static curves, at the map [Pa]; set by the caller
  HeldOutScore score;
  CycleNoise noise;        ///< fitted together with it
  SingleColumn beginning;  ///< of a single effect
};

/// The noise where nothing is missing, and what is fitted together with it.
struct NullFit {
  double stiffness = 0, visit_gain = 0, visit_offset = 0;  ///< see StaticModel
  CycleNoise noise;  ///< at which the fits of the noise under an explanation begin
  CycleNoise best;   ///< with the highest predictive density where nothing is missing
};
NullFit fitNull(const CycleDesign& design);

/// Odds at which an explanation is excluded [nats].
double credibleOdds(const DiscrepancyOptions& options);

/// What a single explanation adds to the best effect.
struct Addition {
  double nats = 0;
  double closes = 0;       ///< share of what can be closed
  SingleColumn beginning;  ///< of an effect that adds something
};

/// A random course that is more than chance: the best one, as an index of the explanations.
struct FoundCourse {
  std::size_t explanation = 0;
  PriorVariance variance;           ///< square of the step in one hour
  double p_beyond = 1;              ///< probability of the best score beyond it if nothing else were missing
  std::vector<std::size_t> rivals;  ///< members of Appraisal::credible that it does not exclude
};

/// What the cycles say of each explanation.
struct Appraisal {
  double p = 1;                       ///< probability of the best score if nothing were missing
  double p_beyond = 1;                ///< the same for the best addition to the best explanation by effects
  double null_score = 0;              ///< score that chance alone exceeds with probability `level` [nats]
  NullFit null;                       ///< as given, or with a better noise that was found
  std::vector<Weighed> all;           ///< in the order of the explanations
  std::size_t best = 0;               ///< of all
  std::vector<std::size_t> credible;  ///< explanations by effects that are not excluded, best first
  std::vector<std::size_t> generic;   ///< explanations by generic terms that the best effects do not exclude
  std::vector<Addition> additions;    ///< of each explanation; empty where nothing is left beyond the best
  bool own_form_better = false;  ///< generic terms of the best effects' own covariates are better than these
  bool generic_better = false;   ///< generic terms of other covariates are better than both
  /// Set where a random course scores beyond chance and a smooth course is excluded with the probability
  /// `credible`. It does not compete with the others.
  std::optional<FoundCourse> course;
  /// Smallest coefficient of each column that would be found; none = no effect uses the column.
  std::vector<std::optional<double>> least_seen;
};

/// Nats that one effect adds to another in any form: the generic terms of the other's covariates belong to
/// the model. Where a slow effect is added to a fast one, all fast generic terms do, because a fast effect of
/// another form leaves slow traces. `one`, `to`: indices of `explanations`.
double addedToAnyForm(const CycleDesign& design, const NullFit& null,
                      const std::vector<Explaining>& explanations, std::size_t one, std::size_t to,
                      const DiscrepancyOptions& options);

/// A slow effect beside another one, as an index of the explanations.
struct Beside {
  std::size_t explanation = 0;
  SingleColumn beginning;
};

/// Slow effects that explain more of the gains of the cycles than chance does (see chanceByGains), both of
/// what the fast effect `to` leaves of the readings and of what any form of it leaves.
std::vector<Beside> slowBeside(const CycleDesign& design, const NullFit& null,
                               const std::vector<Explaining>& explanations, std::size_t to,
                               const DiscrepancyOptions& options);

/// Weighs the explanations as `options` say. Pairs among them compete like single effects. The result does
/// not depend on the number of threads.
Appraisal appraise(const CycleDesign& design, const NullFit& null,
                   const std::vector<Explaining>& explanations, const DiscrepancyOptions& options);

}  // namespace fsr::discrepancy
