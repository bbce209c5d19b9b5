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

}  // namespace fsr::discrepancy
