#pragma once

#include <vector>

#include "fsr_pressure_map/discrepancy/decision.h"
#include "fsr_pressure_map/discrepancy/taxel_fit.h"

namespace fsr {

/// Where a trace shows, by what the static curves leave of it and by how much of it each taxel and each
/// class of curvature has. Members are those with at least a fifth of the largest.
WhereItShows placeOf(const Measured& measured, const Trace& left, const Spread& spread);

/// Factor of the trace in each taxel on each class, [taxels x classes]: 0 where it does not show, else
/// one number.
Eigen::MatrixXd maskOf(const Measured& measured, const WhereItShows& where, const Spread& spread);

/// Squared errors that the curves of each surface hide, or that detectors explain [share of full scale,
/// squared].
struct GapExtras {
  double before_more = 0;  ///< that the gap before has more
  double after_less = 0;   ///< that the gap after, and the floor, have less
};

/// The gap on the cycles that took no part. `left`: what the static curves leave of the trace that the
/// effects add; `mask` as above; `ceiling`: share of the squared error before that anything explains.
Gap measureGap(const Measured& measured, const StaticFit& fit, const TaxelFit& taxels, const Trace& left,
               const Eigen::MatrixXd& mask, double ceiling, const GapExtras& extras, std::uint64_t seed);

/// Mean residual of the common trace over covariates, before and after, on the cycles that took no part.
std::vector<ResidualCurve> residualCurves(const Measured& measured, const Trace& before, const Trace& after);

}  // namespace fsr
