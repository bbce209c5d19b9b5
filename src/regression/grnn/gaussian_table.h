#pragma once

#include <cstddef>
#include <vector>

#include "regression/grnn/weighted_codes.h"

namespace fsr::regression {

/// Codes whose sums are formed together, so many that the sums stay in registers.
constexpr std::ptrdiff_t kCodeBlock = 32;

/// exp(-d^2 / 2 sigma^2) at whole distances up to a radius, laid out for sums over blocks of codes.
class GaussianTable {
 public:
  /// `sigma` > 0, `radius` >= 0 [counts].
  GaussianTable(double sigma, std::ptrdiff_t radius);

  std::ptrdiff_t radius() const { return radius_; }

  /// At the codes block .. block + kCodeBlock - 1: sums of pressure [Pa] and of weight over the samples
  /// first .. last - 1, all of which lie within the radius of some code of the block.
  void sumBlock(const WeightedCodes& samples, std::size_t first, std::size_t last, std::ptrdiff_t block,
                double* sums, double* weights) const;

 private:
  std::ptrdiff_t radius_;
  std::vector<double> values_;  // at distances -(radius + block) .. radius + block
};

}  // namespace fsr::regression
