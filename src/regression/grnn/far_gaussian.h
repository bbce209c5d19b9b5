#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "regression/grnn/gaussian_table.h"
#include "regression/grnn/kernel_mean.h"

namespace fsr::regression {

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

}  // namespace fsr::regression
