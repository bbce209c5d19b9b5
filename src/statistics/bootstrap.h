#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace fsr::statistics {

/// A grouping of the observations into units: mounts, cycles, taxels.
struct ResamplingLevel {
  std::string name;               ///< name of a unit: "mount", "cycle", ...
  std::vector<std::size_t> unit;  ///< of each observation; equal numbers are the same unit
};

/// The uncertainty of a number computed from observations that are not independent: 45,000 readings of one
/// sheet in ten cycles are not 45,000 samples. Whole units are resampled instead of observations. They are
/// those of the highest level with kFewestUnits units, because the variation between mounts does not show
/// between cycles.
struct BootstrapProblem {
  /// Groupings of the same observations, the highest level (sheet, mount) first.
  std::vector<ResamplingLevel> levels;
  /// Computes the number from indices of observations. Indices are repeated where a unit was drawn twice.
  /// With several threads it is called concurrently.
  std::function<double(const std::vector<std::size_t>& observations)> statistic;
};

struct BootstrapOptions {
  double confidence = 0.95;
  std::size_t resamples = 1999;
  std::uint64_t seed = 1;
  std::string stream = "bootstrap";  ///< streams of other names are independent (random_stream.h)
  std::size_t threads = 1;           ///< does not change the result
};

enum class IntervalMethod {
  kNone,  ///< no level has enough units: the number holds for these units only
  kT,     ///< jackknife error and Student's t, below kFewestForBca units
  kBca,
};

struct BootstrapResult {
  double estimate = std::numeric_limits<double>::quiet_NaN();  ///< statistic of all observations
  double low = std::numeric_limits<double>::quiet_NaN();
  double high = std::numeric_limits<double>::quiet_NaN();
  double standard_error =
      std::numeric_limits<double>::quiet_NaN();  ///< kT: of the jackknife; kBca: of the resamples
  IntervalMethod method = IntervalMethod::kNone;
  std::string level;          ///< level that was resampled; kNone: the lowest
  std::size_t units = 0;      ///< on that level
  std::size_t resamples = 0;  ///< resamples with a finite statistic (a bin may be empty)
};

constexpr std::size_t kFewestUnits = 5;
/// With fewer units there are too few distinct resamples, and they are too narrow (by sqrt(1 - 1/n)) for BCa.
constexpr std::size_t kFewestForBca = 10;

/// Interval of the statistic. With theta_(i) the statistic without unit i,
///
///   t:   theta +- t_{n-1} sqrt((n-1)/n sum_i (theta_(i) - mean)^2); of a mean it is Student's interval
///   BCa: see bcaInterval
///
/// Deterministic: resample r draws from stream number r. The method is also kNone where the statistic without
/// a unit is not finite, or that of more than half of the resamples.
/// InputError: no level, levels of different lengths, no observation, the statistic of all observations
/// not finite, confidence outside (0, 1), no resamples.
BootstrapResult bootstrap(const BootstrapProblem& problem, const BootstrapOptions& options = {});

struct Interval {
  double low = 0;
  double high = 0;
};

/// Bias-corrected and accelerated interval: quantiles of the replicates at
///
///   Phi(z0 + (z0 + z) / (1 - a (z0 + z))),  z0 = Phi^-1(share of replicates below the estimate),
///   a = sum l_i^3 / (6 (sum l_i^2)^1.5),    l_i = mean of theta_(.) - theta_(i),
///
/// interpolated between order statistics on the normal scale. It corrects median bias and skewness.
/// Source: B. Efron, J. Am. Stat. Assoc. 82 (1987) 171-185; A. Davison, D. Hinkley, Bootstrap Methods and
/// their Application, 1997, eq. 5.8 and sec. 5.3. The result is that of R's boot::boot.ci(type = "bca") given
/// l, with two exceptions: a replicate equal to the estimate counts half (for discrete statistics), and for
/// an estimate beyond all replicates half a replicate is assumed beyond it (R stops). `replicates` must be
/// finite and not empty.
Interval bcaInterval(double estimate, std::vector<double> replicates, const std::vector<double>& jackknife,
                     double confidence);

}  // namespace fsr::statistics
