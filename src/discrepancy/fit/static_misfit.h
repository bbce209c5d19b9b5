#pragma once

#include "discrepancy/fit/static_fit.h"
#include "discrepancy/samples/measured.h"

namespace fsr::discrepancy {

/// Misfit that remains after the curves of all surfaces have been mapped onto the first surface's curve by
/// gain and preload.
struct StaticMisfit {
  double share = 0;   ///< share of the readings' squared error
  double rms = 0;     ///< [share of full scale]
  double at_map = 0;  ///< rms of the misfit divided by the slope of the curves [Pa]
  /// Share of the misfit that is no misfit if the read-out limits high readings, on all surfaces alike. Any
  /// concave limit above half of the highest reading is fitted.
  double by_limit = 0;
  double level = 0, sharpness = 0;      ///< of the effect `saturation` nearest to this limit; level [counts]
  Interval pressure;                    ///< where the misfit shows [Pa]
  std::vector<std::string> conditions;  ///< where the misfit shows; empty = all
};
/// Measures this misfit. Differences that may be due to chance count as 0. Below the least share of the error
/// that matters, only the sizes are set.
StaticMisfit findStaticMisfit(const Measured& measured, const StaticFit& fit, const Trace& common,
                              double square);

}  // namespace fsr::discrepancy
