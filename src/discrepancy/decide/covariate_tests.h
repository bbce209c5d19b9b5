#pragma once

#include <cstdint>
#include <vector>

#include "discrepancy/decide/candidates.h"
#include "discrepancy/fit/taxel_fit.h"

namespace fsr::discrepancy {

/// Whether what the static curves leave depends on each covariate, asked before any effect is named, of the
/// cycles to fit.
///
/// Within a cycle (direction, rate, time since the reversal, extremes, curvature, row, column, taxel): cycles
/// are exchangeable, and by chance alone each could as well have left the opposite. So whole cycles change
/// their sign, 9,999 times; with fewer than kFewestExchangeable a parametric block bootstrap stands in. From
/// cycle to cycle (cycle, clock time, way, temperature, mount) signs may not change: gain and zero of each
/// cycle are drawn anew as a normal distribution with the scatter from one cycle to the next. Pressure, code
/// and total load are left out: under a uniform load the static curves take all that depends on them.
///
/// An effect counts where p, adjusted by Benjamini and Yekutieli over all tests, is at most 0.05 and it
/// explains at least 2 % of the readings' squared error. The same on any number of threads.
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
