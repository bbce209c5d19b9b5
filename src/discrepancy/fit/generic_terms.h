#pragma once

#include <string>
#include <vector>

#include "discrepancy/fit/static_fit.h"
#include "discrepancy/samples/measured.h"
#include "fsr_pressure_map/simulation/effect_info.h"

namespace fsr::discrepancy {

/// Smooth terms of some covariates, whatever physics may be behind them: how much is explainable at
/// all, and by what. Load-like ones go through the static curves' slope, gain-like ones through their
/// rise.
struct GenericTerms {
  std::vector<simulation::Covariate> covariates;
  std::vector<Trace> columns;  ///< projected; all signs are free
};

/// The terms of each group of covariates; where the recordings have several curvatures, each once more
/// with curvature (`columns` then holds the plain terms as well).
std::vector<GenericTerms> genericTerms(const Measured& measured, const StaticFit& fit);

}  // namespace fsr::discrepancy
