#pragma once

#include <cstdint>
#include <vector>

#include "discrepancy/decide/candidates.h"
#include "discrepancy/fit/taxel_fit.h"

namespace fsr::discrepancy {

/// Tests whether the residuals of the static curves depend on each covariate. The tests use the cycles to fit
/// and are made before any effect is named.
///
/// Within a cycle (direction, rate, time since the reversal, extremes, curvature, row, column, taxel): cycles
/// are exchangeable, and under the null hypothesis each residual could as well have the opposite sign. A
/// permutation test flips the signs of whole cycles 9,999 times. With fewer than kFewestExchangeable cycles a
/// parametric block bootstrap is used instead. From cycle to cycle (cycle, clock time, path length,
/// temperature, mount): signs must not be flipped. Gain and zero of each cycle are drawn from a normal
/// distribution with the scatter between consecutive cycles. Pressure, code and total load are left out:
/// under a uniform load the static curves absorb everything that depends on them.
///
/// A dependence counts where p, adjusted by Benjamini and Yekutieli over all tests, is at most 0.05, and
/// where it explains at least 2 % of the squared error of the readings. The result does not depend on the
/// number of threads.
struct CovariateTests {
  static constexpr std::size_t kFewestExchangeable = 12;

  const Measured& measured;
  const CommonTraces& common;
  const StaticFit& fit;
  const TaxelFit& taxels;
  const Candidates& candidates;
  std::uint64_t seed = 1;
  std::uint64_t draws = 9999;

  std::vector<CovariateTest> run() const;
};

}  // namespace fsr::discrepancy
