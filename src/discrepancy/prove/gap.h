#pragma once

#include <functional>
#include <vector>

#include "discrepancy/decide/decision.h"
#include "discrepancy/fit/taxel_fit.h"
#include "discrepancy/samples/held_out.h"

namespace fsr::discrepancy {

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

/// What a gap is measured against.
struct GapGround {
  const Measured& measured;
  const StaticFit& fit;
  const TaxelFit& taxels;
  const Eigen::MatrixXd& mask;  ///< as above
  double explainable = 0;       ///< share of the squared error before that anything explains
  GapExtras extras;
  std::uint64_t seed = 0;
};

/// The gap on those of the cycles that took no part. `left`: what the static curves leave of the trace that
/// the effects add.
Gap measureGap(const GapGround& ground, const Trace& left, const std::vector<std::size_t>& cycles);

/// What an explanation takes from the common trace, each part foretold by the rest: `left` is asked for the
/// whole trace as it comes out without one part. Parts are independent of each other.
Trace predictedByTheRest(const Measured& measured, const std::vector<Part>& parts, unsigned threads,
                         const std::function<Trace(const Part& part)>& left);

/// Indices of all cycles.
std::vector<std::size_t> allCycles(const Measured& measured);

/// Mean residual of the common trace over covariates, before and after, on the cycles that took no part.
std::vector<ResidualCurve> residualCurves(const Measured& measured, const Trace& before, const Trace& after);

}  // namespace fsr::discrepancy
