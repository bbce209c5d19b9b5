#pragma once

#include <cstdint>
#include <vector>

#include "discrepancy/decide/decision.h"
#include "discrepancy/fit/static_fit.h"
#include "discrepancy/samples/measured.h"
#include "fsr_pressure_map/discrepancy/discrepancy.h"
#include "fsr_pressure_map/simulation/simulation_settings.h"

namespace fsr::discrepancy {

/// What effects with fixed parameters explain of new recordings.
struct Predicted {
  double share = 0;     ///< share of the projected common trace's squared error, without any fit
  double size = 1;      ///< common factor of all strengths that fits best
  double variance = 0;  ///< of `size`, by the scatter between these cycles
  /// Variance of the size that fits best if the effects are right, by the spread of their parameters.
  double of_spread = 0;
  Trace trace;  ///< what the effects of this size add to the common trace's residual
  /// Of each cycle: the size that fits it best, less `size`, and the information on it.
  std::vector<double> apart, information;
};
/// `spread`: of the effects' parameters. Under another protocol than that of the fit, a shape that is not
/// well known changes the size that fits best.
Predicted predict(const Measured& measured, const CommonTraces& common, const StaticFit& fit,
                  const simulation::SimulationSettings& base,
                  const std::vector<simulation::EnabledEffect>& effects, const ParameterSpread& spread = {});

/// Whether prediction.hash is the hash of this prediction and this simulation.
///
/// Three forms are accepted. hashOf() gives the third where the prediction has weights or a spread, and the
/// second where it has neither, as in files of earlier versions. Files of early development versions hold the
/// first form, which covers the effects (values to 9 digits), the size of the matrix and the predicted size,
/// but nothing else of the simulation. A file with the first form is therefore still checked, but not as
/// completely.
bool hasItsHash(const Prediction& prediction, const simulation::SimulationSettings& simulation);

/// The first form of the hash, for reading old files.
std::string firstHashOf(const Prediction& prediction, const simulation::SimulationSettings& simulation);

/// Probability of each explanation to be the one with the highest predictive density. `densities`: of each
/// explanation, by cycle [nats]. Bayesian bootstrap over the cycles. Source: Y. Yao, A. Vehtari, D. Simpson,
/// A. Gelman, Using stacking to average Bayesian predictive distributions, Bayesian Analysis 13 (2018)
/// 917-1007, pseudo-BMA+.
std::vector<double> weightsOf(const std::vector<std::vector<double>>& densities, std::size_t draws,
                              std::uint64_t seed);

/// Sets `between` and `groups` of a spread: how much the size differs between mounts and protocols. The form
/// of an effect is never exact, so another protocol gives another size. Method of moments of R. DerSimonian,
/// R. Kacker, Contemporary Clinical Trials 28 (2007) 105-114, weighted by the information of the groups.
void judgeGroups(const Measured& measured, const Predicted& here, ParameterSpread& spread);

/// Where the size of predicted effects lies in 95 of 100 recordings if the prediction is right: a t interval
/// round 1. Its variance is that of the difference of two estimates, with the degrees of freedom of B. Welch,
/// Biometrika 34 (1947) 28-35. `cycles`: of the new recordings.
Interval predictiveInterval(const Predicted& here, const ParameterSpread& spread, std::size_t cycles);

/// 95 % interval of the size by the new cycles alone.
Interval sizeInterval(const Predicted& here, std::size_t cycles);

/// The prediction of a decision. `measured`, `common`, `fit`: the recordings that it was made with.
Prediction freeze(const Decision& decision, const Measured& measured, const CommonTraces& common,
                  const StaticFit& fit, const simulation::SimulationSettings& base,
                  const DiscrepancyOptions& options);

}  // namespace fsr::discrepancy
