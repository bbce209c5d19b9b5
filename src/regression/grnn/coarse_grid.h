#pragma once

#include <cstddef>
#include <vector>

#include "regression/grnn/weighted_codes.h"

namespace fsr::regression {

/// Sums of a wide Gaussian kernel at every code, the work of which does not grow with its width.
///
/// A Gaussian is a polynomial to all digits over a fraction of sigma. So each sample is handed to the
/// sixteen nearest nodes of a grid of at most sigma / 10 by Lagrange's weights, the kernel acts from node
/// to node, and each code reads its value off its sixteen nearest nodes by the same weights. The kernel
/// between any sample and code is then right to 2e-15 of its peak, whatever their distance. (By
/// comparison, an FFT's error is a share of the largest sum anywhere.)
class CoarseGrid {
 public:
  /// Whether the grid saves work at all.
  static bool suits(double sigma);

  /// Samples farther than `reach` from a code need not count there [counts].
  CoarseGrid(const WeightedCodes& samples, double sigma, double reach);

  /// Sums of pressure [Pa] and of weight at the codes begin .. end - 1.
  void sumCodes(std::ptrdiff_t begin, std::ptrdiff_t end, double* sums, double* weights) const;

 private:
  // Values at codes, ordered for the vector unit: those at the same offset within all cells stand
  // together, [spacing x cells].
  using CellValues = std::vector<double>;

  std::vector<std::size_t> placesOf(const WeightedCodes& samples) const;
  std::vector<double> toNodes(const std::vector<std::size_t>& places,
                              const std::vector<double>& values) const;
  std::size_t paddedCells() const;
  CellValues toCodes(const std::vector<double>& nodes) const;

  std::size_t spacing_;  // [codes]
  std::size_t cells_;
  std::vector<double> lagrange_;  // [spacing x 16]: of each offset within a cell
  CellValues sum_, weight_;
};

}  // namespace fsr::regression
