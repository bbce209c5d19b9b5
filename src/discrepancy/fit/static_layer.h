#pragma once

#include "discrepancy/fit/static_fit.h"
#include "discrepancy/fit/taxel_fit.h"
#include "discrepancy/samples/measured.h"

namespace fsr::discrepancy {

/// What changes from one mount to the next on the same surface: preload and gain of each taxel, smooth
/// in space.
struct Repositioning {
  bool found = false;
  double share = 0;   ///< of the readings' squared error
  double z = 0;       ///< how far it stands out from changes that know no neighbours
  double offset = 0;  ///< deviation of the preload [Pa]
  double gain = 0;    ///< deviation of the gain, relative
  WhereItShows where;
};

/// `taxels` and `fit`: with curves that all mounts of a surface share. `explained`: what effects with a
/// time course take from the common trace, `mask` their share in each taxel; both may be empty.
Repositioning findRepositioning(const Measured& measured, const StaticFit& fit, const TaxelFit& taxels,
                                const Trace& explained, const Eigen::MatrixXd& mask);

/// What is left where the curves of all surfaces are referred to the first one's by gain and preload.
struct StaticMisfit {
  double share = 0;                     ///< of the readings' squared error
  double rms = 0;                       ///< [share of full scale]
  double by_code = 0;                   ///< share of it that one function of the reading explains
  Interval pressure;                    ///< where it shows [Pa]
  std::vector<std::string> conditions;  ///< where it shows; empty = all
};
/// Differences that chance may have made count for nothing.
StaticMisfit findStaticMisfit(const Measured& measured, const StaticFit& fit, const Trace& common,
                              double square);

}  // namespace fsr::discrepancy
