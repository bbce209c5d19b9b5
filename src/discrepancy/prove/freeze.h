#pragma once

#include <cstdint>
#include <vector>

#include "discrepancy/decide/decision.h"
#include "discrepancy/decide/predict.h"
#include "fsr_pressure_map/discrepancy/discrepancy.h"

namespace fsr::discrepancy {

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
