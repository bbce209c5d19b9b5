#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

namespace fsr::statistics {

// Split-conformal intervals of readings that come in units, e.g. the cycles or mounts of a session. Readings
// of one unit resemble each other; the units are exchangeable. One reading drawn at random from each of n
// units, and one from a new unit, are exchangeable, too, so that the new score exceeds the k-th smallest of
// the n, k = ceil((n + 1) level), with a probability of at most 1 - level (V. Vovk, A. Gammerman, G. Shafer,
// Algorithmic Learning in a Random World, 2005; J. Lei et al., J. Am. Stat. Assoc. 113, 2018, theorem 2.2).
// The draw is arbitrary. The threshold here is the median of the k-th smallest over all draws (repeated
// subsampling: R. Dunn, L. Wasserman, A. Ramdas, J. Am. Stat. Assoc. 118, 2023). The guarantee of the median
// is 1 - 2 (1 - level); its share in simulations is near `level`.

/// k = ceil((n + 1) level): the threshold is the k-th smallest score. Nothing if n units are too few, which
/// allow at most the level 1 - 1 / (n + 1).
std::optional<std::size_t> conformalRank(std::size_t units, double level);

/// What n units promise of the share of new readings within the interval, if one score is drawn from each:
/// the share differs between trainings as Beta(k, n + 1 - k), k = conformalRank().
struct ConformalCover {
  std::size_t rank = 0;  ///< k
  double mean = 0;       ///< k / (n + 1); at least the level, and below the level + 1 / (n + 1)
  double low = 0;        ///< nine of ten trainings reach a share between `low` and `high`
  double median = 0;     ///< that of the median over draws where all units are alike
  double high = 0;
};
std::optional<ConformalCover> conformalCover(std::size_t units, double level);

/// The smallest number of units that allows the level.
std::size_t conformalUnits(double level);

/// The probability that at least `k` of independent events happen, whose probabilities are given.
double probabilityOfAtLeast(std::size_t k, const std::vector<double>& probability);

/// The smallest number in [0, thresholds) at which the smallest score number `rank` of one drawn from each
/// unit lies at or below threshold number i in at least half of the draws. `shares` as in
/// conformalThreshold().
std::size_t medianThreshold(std::size_t rank, std::size_t thresholds,
                            const std::function<std::vector<double>(std::size_t)>& shares);

/// The smallest number in [0, thresholds) at which the k-th smallest of one score drawn from each unit lies
/// at or below threshold number i in at least half of the draws; nothing if the units are too few.
/// `shares(i)`: for each unit the share of its scores at or below threshold i, not decreasing in i and 1 at
/// the last one.
std::optional<std::size_t> conformalThreshold(std::size_t units, double level, std::size_t thresholds,
                                              const std::function<std::vector<double>(std::size_t)>& shares);

}  // namespace fsr::statistics
