#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "fsr_pressure_map/statistics/metrics.h"
#include "statistics/samples.h"

namespace fsr::statistics {

/// Sizes of errors, for quantiles. Up to kKept of them are kept, so that a quantile is exact. More are
/// counted in cells of 1/4096 of an octave: a quantile is then within 0.013 % of itself, and the memory no
/// longer grows.
class ErrorSizes {
 public:
  static constexpr std::size_t kKept = 131072;

  void add(float error);
  void merge(const ErrorSizes& other);
  std::uint64_t count() const { return count_; }

  /// The q-quantile of |error|, 0 <= q <= 1, interpolated between order statistics as quantile() does. NaN
  /// for no error.
  double quantile(double q) const;

 private:
  static constexpr std::size_t kOctaves = 256;  // exponents of a float
  static constexpr std::size_t kCells = 4096;   // of an octave

  void tally(float size, std::uint64_t times);
  void tallyKept();
  double ordered(std::uint64_t rank) const;

  std::uint64_t count_ = 0;
  std::vector<float> kept_;                          // empty once cells are counted
  std::vector<std::vector<std::uint64_t>> octaves_;  // empty = all are kept; [octaves][cells], [] = none
};

/// Errors one after another, for the summary of summariseErrors().
class ErrorTally {
 public:
  void add(float error);
  /// Another order of merges changes the rounding of the sums.
  void merge(const ErrorTally& other);
  std::uint64_t count() const { return sizes_.count(); }
  ErrorSummary summarise() const;

 private:
  RunningMoments moments_;
  ErrorSizes sizes_;
};

/// Collects errors by pressure bin and direction of load.
class ErrorBins {
 public:
  /// `error` and `reference` in Pa.
  void add(float error, double reference, LoadDirection direction) {
    tallies_[pressureBin(reference)][static_cast<std::size_t>(direction)].add(error);
  }
  void merge(const ErrorBins& other);
  std::uint64_t count() const;
  BinnedErrors summarise() const;

 private:
  static constexpr std::size_t kDirections = 3;
  std::array<std::array<ErrorTally, kDirections>, kPressureBins> tallies_;
};

/// rSquared() and rmsePercent() of metrics.h for values that come one after another: number, range and
/// scatter of reference values. The digits are the same, and the memory does not grow with their number. Each
/// value is given to add(), and then, in the same order, to addAgain().
class ReferenceScatter {
 public:
  void add(double reference);
  void addAgain(double reference);

  double range() const { return high_ - low_; }  ///< largest - smallest

  /// rSquared() and rmsePercent() of predictions with this sum of squared errors, added in that order.
  double rSquared(double squared_errors) const;
  double rmsePercent(double squared_errors) const;

 private:
  double number_ = 0, sum_ = 0, squares_ = 0;
  double low_ = std::numeric_limits<double>::infinity(), high_ = -low_;
};

}  // namespace fsr::statistics
