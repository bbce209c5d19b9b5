#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "regression/grnn/kernel_mean.h"
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

/// Kernel values of a larger exponent are treated as 0. The limit is far from the smallest double, so that
/// quotients of sums keep full precision.
constexpr double kLargestKernelExponent = 600.0;

/// Gaussian means at codes so far from every sample that kernel values underflow. They are computed relative
/// to the kernel value of the nearest sample, at distance n. A sample at distance j beyond it on its side has
/// the relative value exp(-p (2 n j + j^2)): the j-th power of one exponential times a value that all codes
/// share.
class FarGaussian {
 public:
  /// `precision` = p = 1 / 2 sigma^2 [1/counts^2]. Samples with d^2 > n^2 + `beyond_nearest` [counts^2] are
  /// left out. `samples` must outlive the object.
  FarGaussian(const WeightedCodes& samples, double precision, double beyond_nearest, LogWeight log_weight)
      : samples_(samples), precision_(precision), beyond_nearest_(beyond_nearest), log_weight_(log_weight) {}

  /// Computes the codes begin .. end - 1, at most one block.
  void sumBlock(std::ptrdiff_t begin, std::ptrdiff_t end, KernelMean& mean);

 private:
  using BlockValues = std::array<double, kCodeBlock>;
  struct Sums {
    double pressure = 0, weight = 0;
  };

  void sumBeyondAll(std::ptrdiff_t begin, std::ptrdiff_t end, KernelMean& mean);
  void sumCode(std::ptrdiff_t code, KernelMean& mean);
  // Adds the samples first, first + step, ...; the first is `distance` away.
  void addSide(double distance, double nearest, std::ptrdiff_t first, std::ptrdiff_t step, Sums& sums);
  void store(std::ptrdiff_t code, double nearest, Sums sums, KernelMean& mean) const;
  double shared(std::ptrdiff_t j);  // exp(-p j^2)
  // exp(-2 p i): the factor between the bases of the powers of neighbouring codes.
  const BlockValues& stepPowers();

  const WeightedCodes& samples_;
  double precision_, beyond_nearest_;
  LogWeight log_weight_;
  std::optional<BlockValues> step_powers_;
  std::vector<double> shared_;
};

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
