#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "fsr_pressure_map/statistics/metrics.h"

namespace fsr::statistics {

// The measures of metrics.h for values that come one after another. The digits are the same, and the memory
// does not grow with the number of values.

/// Number, range and scatter of reference values. Each value is given to add(), and then, in the same order,
/// to addAgain().
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

/// The summary of summariseErrors(). Each error is given to add(), and then, in the same order, to
/// addAgain().
class StreamedSummary {
 public:
  StreamedSummary();
  void add(float error);
  void addAgain(float error);
  ErrorSummary summarise() const;

 private:
  // The errors of one rank are found in two steps: by the upper 16 bits of their size, then by the lower 16
  // bits among those of the same upper ones. Bits of positive floats are in the order of the floats.
  struct Rank {
    std::uint64_t rank = 0;
    std::uint32_t upper = 0;
    std::uint64_t before = 0;          // errors of smaller upper bits
    std::vector<std::uint64_t> lower;  // errors by lower bits
  };
  void find(Rank& rank) const;
  static double sizeOf(const Rank& rank);

  std::uint64_t count_ = 0;
  double sum_ = 0, squares_ = 0, mean_ = 0, squares_about_mean_ = 0;
  std::vector<std::uint64_t> upper_;  // errors by the upper bits of their size
  std::array<Rank, 2> ranks_;         // below and above the quantile; found before the second pass
  bool again_ = false;
};

}  // namespace fsr::statistics
