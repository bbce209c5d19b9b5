#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace fsr::statistics {

/// One way to group the observations into units: mounts, cycles, taxels.
struct ResamplingLevel {
  std::string name;               ///< of one unit: "mount", "cycle", ...
  std::vector<std::size_t> unit;  ///< of each observation; any numbers, equal ones belong together
};

/// How sure is a number that was computed from observations which are not independent? 45,000 readings
/// of one sheet in ten cycles are not 45,000 samples. Units are resampled instead, whole: of the highest
/// level that has kFewestUnits of them, since what varies between mounts does not show between cycles.
struct BootstrapProblem {
  /// All on the same observations, the highest (sheet, mount) first.
  std::vector<ResamplingLevel> levels;
  /// The number, from the indices of observations, repeated where a unit was drawn twice. Called from
  /// several threads at once where options ask for them.
  std::function<double(const std::vector<std::size_t>& observations)> statistic;
};

struct BootstrapOptions {
  double confidence = 0.95;
  std::size_t resamples = 1999;
  std::uint64_t seed = 1;
  std::string stream = "bootstrap";  ///< streams of other names are independent (random_stream.h)
  std::size_t threads = 1;           ///< changes no number
};

enum class IntervalMethod {
  kNone,  ///< no level has units enough: the number holds for these units only
  kT,     ///< jackknife error and Student's t: below kFewestForBca units
  kBca,
};

struct BootstrapResult {
  double estimate = std::numeric_limits<double>::quiet_NaN();  ///< of all observations
  double low = std::numeric_limits<double>::quiet_NaN();
  double high = std::numeric_limits<double>::quiet_NaN();
  double standard_error =
      std::numeric_limits<double>::quiet_NaN();  ///< kT: jackknife; kBca: of the resamples
  IntervalMethod method = IntervalMethod::kNone;
  std::string level;          ///< resampled; kNone: the lowest
  std::size_t units = 0;      ///< on that level
  std::size_t resamples = 0;  ///< used: those with a finite statistic (a bin may run empty)
};

constexpr std::size_t kFewestUnits = 5;
/// With fewer units the resamples are too few distinct ones and too narrow (by sqrt(1 - 1/n)) for BCa.
constexpr std::size_t kFewestForBca = 10;

/// Interval of the statistic. With theta_(i) the statistic without unit i,
///
///   t:   theta +- t_{n-1} sqrt((n-1)/n sum_i (theta_(i) - mean)^2); of a mean it is Student's interval
///   BCa: see bcaInterval
///
/// Deterministic: resample r draws from the stream of its own number r. kNone too where leaving out a
/// unit leaves no finite statistic, or fewer than half the resamples have one.
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
/// interpolated between order statistics on the normal scale. Corrects median bias and skewness.
/// Source: B. Efron, J. Am. Stat. Assoc. 82 (1987) 171-185; A. Davison, D. Hinkley, Bootstrap Methods and
/// their Application, 1997, eq. 5.8 and sec. 5.3. As R's boot::boot.ci(type = "bca") given l, except that
/// a replicate equal to the estimate counts half (statistics that jump), and that an estimate beyond all
/// replicates is taken as beyond all but one half of one (R stops). `replicates` finite, not empty.
Interval bcaInterval(double estimate, std::vector<double> replicates, const std::vector<double>& jackknife,
                     double confidence);

}  // namespace fsr::statistics
