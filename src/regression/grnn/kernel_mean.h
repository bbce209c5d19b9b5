#pragma once

#include <vector>

#include "regression/grnn/weighted_codes.h"

namespace fsr::regression {

/// Kernel-weighted mean of the training pressures at every code, f = sum w P / sum w.
struct KernelMean {
  std::vector<double> pressure;  ///< [Pa], finite
  /// Sum of kernel values at each code, the kernel being 1 at distance 0; 0 where it underflows.
  std::vector<double> weight;
  /// Its logarithm, finite at every code; empty where not asked for.
  std::vector<double> log_weight;
};

/// Whether to give the logarithm of the weight: what combines the means of several curvatures where no
/// sample of any is near.
enum class LogWeight {
  kNo,
  kYes,
  kWhereZero,  ///< only where `weight` is 0, elsewhere unspecified: logarithms take longer than sums
};

/// Share of the pressure range that all left-out samples together may move an answer by.
constexpr double kNegligibleShare = 1e-14;

/// Kernel exp(-d^2 / 2 sigma^2), sigma > 0 [counts]. Error below 1e-12 of the pressure range at every code.
///
/// Where every weight underflows the quotient is 0 / 0. The smallest distance is taken out of all
/// exponents first, which changes nothing else, so that the answer there is the nearest sample's. Samples
/// with d^2 > d_min^2 + 2 sigma^2 ln(N / kNegligibleShare) are left out.
///
/// Wide kernels go by way of a coarse grid (see coarse_grid.h), so that the work does not grow with sigma.
KernelMean gaussianMean(const WeightedCodes& samples, double sigma, LogWeight log_weight = LogWeight::kNo);

/// Kernel exp(-|d| / length), length > 0 [counts]; the smallest distance is taken out likewise.
KernelMean laplaceMean(const WeightedCodes& samples, double length, LogWeight log_weight = LogWeight::kNo);

}  // namespace fsr::regression
