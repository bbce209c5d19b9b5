#pragma once

#include <cstddef>
#include <vector>

#include "regression/grnn/weighted_codes.h"

namespace fsr::regression {

/// Sums of a wide Gaussian kernel at every code. The work does not grow with the width.
///
/// Over a fraction of sigma a Gaussian is a polynomial to double precision. Each sample is therefore
/// distributed to the sixteen nearest nodes of a grid with a spacing of at most sigma / 10 by Lagrange
/// weights, the kernel is applied from node to node, and each code is interpolated from its sixteen nearest
/// nodes by the same weights. The error of the kernel between any sample and code is below 2e-15 of its peak,
/// whatever their distance. (The error of an FFT is a share of the largest sum anywhere.)
class CoarseGrid {
 public:
  /// Whether the grid saves work.
  static bool suits(double sigma);

  /// Samples farther than `reach` from a code may be ignored there [counts].
  CoarseGrid(const WeightedCodes& samples, double sigma, double reach);

  /// Sums of pressure [Pa] and of weight at the codes begin .. end - 1.
  void sumCodes(std::ptrdiff_t begin, std::ptrdiff_t end, double* sums, double* weights) const;

 private:
  // Values at codes in an order for vectorisation: values at the same offset within all cells are adjacent,
  // [spacing x cells].
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
