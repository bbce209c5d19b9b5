#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "discrepancy/decide/decision.h"
#include "discrepancy/fit/taxel_fit.h"
#include "discrepancy/samples/views.h"
#include "fsr_pressure_map/discrepancy/discrepancy.h"

namespace fsr::discrepancy {

/// Sets the 95 % intervals of `gap` by a bootstrap over its cycles. `of(chosen)` returns the gap of the
/// chosen cycles, indices below `cycles` that may repeat. Without a cycle the intervals are NaN.
void setIntervals(std::size_t cycles, std::uint64_t seed,
                  const std::function<Gap(const std::vector<std::size_t>& chosen)>& of, Gap& gap);

/// Finds where a trace shows: its taxels, surfaces, pressures and direction. `left`: residual of the trace
/// after the static curves. `spread`: amplitude of the trace in each taxel and each class of curvature. The
/// trace shows in those taxels and classes that have at least a fifth of the largest value.
WhereItShows placeOf(const Measured& measured, const Trace& left, const Spread& spread);

/// Factor of the trace in each taxel on each class, [taxels x classes]. It is 0 where the trace does not
/// show, and the same number everywhere else.
Eigen::MatrixXd maskOf(const Measured& measured, const WhereItShows& where, const Spread& spread);

/// Mean squared errors that the static curves of each surface hide, or that detectors explain [share of full
/// scale, squared].
struct GapExtras {
  double before_more = 0;  ///< to be added to the error before
  double after_less = 0;   ///< to be subtracted from the error after; the floor is never above the result
};

/// The data against which a gap is measured.
struct GapGround {
  const Measured& measured;
  const StaticFit& fit;
  const TaxelFit& taxels;
  const Eigen::MatrixXd& mask;  ///< see maskOf()
  double explainable = 0;       ///< share of the squared error before that can be explained at all
  GapExtras extras;
  std::uint64_t seed = 0;
};

/// Measures the gap of fitted traces on those of `cycles` that are held out. It serves for surfaces and
/// protocols that are predicted from the others; the gap that is reported is measured by driving simulations.
/// `left`: residual, after the static curves, of the trace that the effects add.
Gap measureGap(const GapGround& ground, const Trace& left, const std::vector<std::size_t>& cycles);

/// Predicts in each part what an explanation removes from the common trace, using only the other parts.
/// `left(part)` returns the whole trace from a fit without `part`. The calls do not depend on each other;
/// they run on up to `threads` threads. Samples outside all parts are 0.
Trace predictedByTheRest(const Measured& measured, const std::vector<Part>& parts, unsigned threads,
                         const std::function<Trace(const Part& part)>& left);

/// Indices of all cycles.
std::vector<std::size_t> allCycles(const Measured& measured);

/// Mean residual of the common trace against each covariate, before and after, over all samples.
std::vector<ResidualCurve> residualCurves(const Measured& measured, const Trace& before, const Trace& after);

}  // namespace fsr::discrepancy
