#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace fsr::statistics {

/// Lower edges of the bins in which errors and coverage are stated, gauge [Pa]. The first bin also includes
/// lower pressures, because the readings of a vented chamber scatter around zero. The last has no upper edge.
constexpr std::array<double, 5> kPressureBinEdges = {0.0, 50e3, 100e3, 200e3, 400e3};
constexpr std::size_t kPressureBins = kPressureBinEdges.size();

/// Number of the bin that contains `pressure` [Pa].
std::size_t pressureBin(double pressure);

/// "0-50", ..., "400+" [kPa, gauge].
std::string pressureBinName(std::size_t bin, double unit = 1e3);

/// Whether the chamber was being loaded or unloaded when a scan was taken. A dwell belongs to the direction
/// before it.
enum class LoadDirection : std::uint8_t {
  kNone,       ///< the pressure never changes
  kLoading,    ///< from a cycle's valley to its peak
  kUnloading,  ///< from the peak to the next valley
};

// Measures of the errors of predictions. An error is predicted - reference. A measure that has no meaning for
// the data is NaN; every function says when.

/// R2 = 1 - SSE / SST, with SST about the mean of `reference`. Negative where the mean predicts better.
/// NaN where the reference has fewer than two values or does not vary.
double rSquared(const std::vector<double>& predicted, const std::vector<double>& reference);

/// Root of the mean squared error in percent of the range (largest - smallest) of `reference`.
/// NaN where the reference is empty or does not vary.
double rmsePercent(const std::vector<double>& predicted, const std::vector<double>& reference);

/// The q-quantile, 0 <= q <= 1, interpolated between order statistics (R's type 7, numpy's default).
/// NaN for an empty list. Reorders `values`.
double quantile(std::vector<double>& values, double q);

/// Summary of errors. All NaN where `count` is 0.
struct ErrorSummary {
  std::size_t count = 0;
  double bias = std::numeric_limits<double>::quiet_NaN();       ///< mean error [Pa]
  double rmse = std::numeric_limits<double>::quiet_NaN();       ///< [Pa]
  double limit_low = std::numeric_limits<double>::quiet_NaN();  ///< bias - 1.96 standard deviations [Pa]; NaN
                                                                ///< below two errors
  double limit_high = std::numeric_limits<double>::quiet_NaN();    ///< bias + 1.96 standard deviations [Pa];
                                                                   ///< NaN below two errors
  double p95_absolute = std::numeric_limits<double>::quiet_NaN();  ///< 95th percentile of |error| [Pa]
};

/// `errors` in Pa.
ErrorSummary summariseErrors(const std::vector<double>& errors);

/// Errors by pressure bin, for both directions of load together and for each alone.
struct BinnedErrors {
  struct Directions {
    ErrorSummary all;
    ErrorSummary loading;
    ErrorSummary unloading;
  };
  Directions whole;  ///< all bins together
  std::array<Directions, kPressureBins> bins;
};

/// Mean and sample standard deviation over taxels. NaN values are left out. The mean of no value and the
/// deviation of fewer than two values are NaN.
struct Spread {
  double mean = std::numeric_limits<double>::quiet_NaN();
  double deviation = std::numeric_limits<double>::quiet_NaN();
};
Spread spreadOf(const std::vector<double>& values);

}  // namespace fsr::statistics
