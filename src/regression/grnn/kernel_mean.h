#pragma once

#include <vector>

#include "regression/grnn/weighted_codes.h"

namespace fsr::regression {

/// Kernel-weighted mean of the training pressures at every code, f = sum w P / sum w.
struct KernelMean {
  std::vector<double> pressure;  ///< [Pa], finite
  /// Sum of kernel values at each code, the kernel being 1 at distance 0; 0 where it underflows.
  std::vector<double> weight;
  /// Logarithm of the weight, finite at every code; empty if not asked for.
  std::vector<double> log_weight;
};

/// Whether to compute the logarithm of the weight. It combines the means of several curvatures at codes where
/// no sample is near.
enum class LogWeight {
  kNo,
  kYes,
  kWhereZero,  ///< only where `weight` is 0, elsewhere unspecified: logarithms take longer than sums
};

/// All left-out samples together change an answer by at most this share of the pressure range.
constexpr double kNegligibleShare = 1e-14;

/// Kernel exp(-d^2 / 2 sigma^2), sigma > 0 [counts]. The error is below 1e-12 of the pressure range at every
/// code.
///
/// Where all weights underflow, the quotient would be 0 / 0. The smallest exponent is therefore subtracted
/// from all exponents, which does not change the quotient; the answer there is that of the nearest sample.
/// Samples with d^2 > d_min^2 + 2 sigma^2 ln(N / kNegligibleShare) are left out.
///
/// Wide kernels are computed on a coarse grid (see coarse_grid.h), so that the work does not grow with sigma.
KernelMean gaussianMean(const WeightedCodes& samples, double sigma, LogWeight log_weight = LogWeight::kNo);

/// Kernel exp(-|d| / length), length > 0 [counts]. The smallest exponent is subtracted likewise.
KernelMean laplaceMean(const WeightedCodes& samples, double length, LogWeight log_weight = LogWeight::kNo);

}  // namespace fsr::regression
