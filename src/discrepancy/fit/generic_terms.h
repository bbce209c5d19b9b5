#pragma once

#include <string>
#include <vector>

#include "discrepancy/fit/static_fit.h"
#include "discrepancy/samples/measured.h"
#include "fsr_pressure_map/simulation/effect_info.h"

namespace fsr::discrepancy {

/// Smooth functions of some covariates, independent of the physics behind them. They show how much can be
/// explained at all, and by which covariates. Terms that act like a load are multiplied by the slope of the
/// static curves, terms that act like a gain by their rise.
struct GenericTerms {
  std::vector<simulation::Covariate> covariates;
  std::vector<Trace> columns;  ///< scaled to rms 1, not projected; the sign of each is free
};

/// Returns the terms of each group of covariates. If the recordings have several curvatures, each group
/// except clock time is returned a second time with curvature (`columns` then holds the plain terms as well).
std::vector<GenericTerms> genericTerms(const Measured& measured, const StaticFit& fit);

}  // namespace fsr::discrepancy
