#pragma once

#include <cstddef>
#include <vector>

#include "regression/grnn/weighted_codes.h"

namespace fsr::regression {

/// Number of codes whose sums are computed together, small enough for the sums to stay in registers.
constexpr std::ptrdiff_t kCodeBlock = 32;

/// exp(-d^2 / 2 sigma^2) at integer distances up to a radius, in a layout for sums over blocks of codes.
class GaussianTable {
 public:
  /// `sigma` > 0, `radius` >= 0 [counts].
  GaussianTable(double sigma, std::ptrdiff_t radius);

  std::ptrdiff_t radius() const { return radius_; }

  /// Sums of pressure [Pa] and of weight at the codes block .. block + kCodeBlock - 1 over the samples first
  /// .. last - 1, all of which are within the radius of some code of the block.
  void sumBlock(const WeightedCodes& samples, std::size_t first, std::size_t last, std::ptrdiff_t block,
                double* sums, double* weights) const;

 private:
  std::ptrdiff_t radius_;
  std::vector<double> values_;  // at distances -(radius + block) .. radius + block
};

}  // namespace fsr::regression
