#pragma once

#include "discrepancy/fit/static_fit.h"
#include "discrepancy/fit/taxel_fit.h"
#include "discrepancy/samples/measured.h"

namespace fsr::discrepancy {

/// Change from one mount to the next on the same surface: preload and gain of each taxel, smooth in space.
struct Repositioning {
  bool found = false;
  double share = 0;   ///< share of the readings' squared error
  double z = 0;       ///< z score relative to changes that are independent in neighbouring taxels
  double offset = 0;  ///< standard deviation of the preload [Pa]
  double gain = 0;    ///< standard deviation of the gain, relative
  WhereItShows where;
};

/// `taxels` and `fit` must have curves that all mounts of a surface share. `explained` is the part of the
/// common trace that effects with a time course explain. `mask` [taxels x classes] is the share of these
/// effects in each taxel. Both may be empty.
Repositioning findRepositioning(const Measured& measured, const StaticFit& fit, const TaxelFit& taxels,
                                const Trace& explained, const Eigen::MatrixXd& mask);

/// Misfit that remains after the curves of all surfaces have been mapped onto the first surface's curve by
/// gain and preload.
struct StaticMisfit {
  double share = 0;                     ///< share of the readings' squared error
  double rms = 0;                       ///< [share of full scale]
  double at_map = 0;                    ///< rms of the misfit divided by the slope of the curves [Pa]
  double by_code = 0;                   ///< share of the misfit that one function of the reading explains
  Interval pressure;                    ///< where the misfit shows [Pa]
  std::vector<std::string> conditions;  ///< where the misfit shows; empty = all
};
/// Measures this misfit. Differences that may be due to chance count as 0.
StaticMisfit findStaticMisfit(const Measured& measured, const StaticFit& fit, const Trace& common,
                              double square);

}  // namespace fsr::discrepancy
