#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "regression/bandwidth_search.h"
#include "regression/forest/forest.h"
#include "regression/grnn/grnn.h"
#include "settings/settings.h"
#include "statistics/paper_rule.h"

namespace fsr::study {

/// Which scans are kept if a method uses one of n. The paper does not say.
enum class DownSampling {
  kRandom,      ///< drawn without replacement
  kEveryNth,    ///< the first of every n
  kContiguous,  ///< one contiguous run, at a random position
};

/// "random", "every_nth", "contiguous".
std::string downSamplingName(DownSampling down_sampling);

/// Range of pressure that RMSE% refers to. The paper does not say.
enum class ScoreRange {
  kHeldOut,  ///< range of the held-out readings
  kAll,      ///< range of all scans
};

/// Share of the data that method 4 uses. The paper says "similar to method 3", which leaves it open.
enum class BinaryShare {
  kFullFlat,     ///< all of the flat condition, one in five scans of the curved ones
  kHalfAndHalf,  ///< half of these shares: together as many scans as one condition has
};

/// Options of a study: the choices that the paper leaves open, and the amount of computation.
struct StudyPlan {
  std::string name = "paper";
  std::size_t sections = 5;  ///< of each condition, held out in turn
  DownSampling down_sampling = DownSampling::kRandom;
  BinaryShare binary_share = BinaryShare::kFullFlat;
  ScoreRange range = ScoreRange::kHeldOut;
  regression::GrnnOptions grnn;      ///< for the reproduction; the default bandwidth is the paper's 2^-7
  regression::ForestOptions forest;  ///< its seed is derived from the study's seed
  statistics::PaperRuleOptions tests;
  /// Bandwidths of the grid and of nested cross-validation.
  std::vector<double> bandwidths = regression::bandwidthGrid();
  /// Approximate number of taxels, equally spaced, on which bandwidth, length scale and curvature ranges are
  /// learned. They are used for all taxels.
  std::size_t bandwidth_taxels = 10;
  std::size_t resamples = 1999;  ///< of the bootstrap
  /// Whether to go beyond the paper: all scans, bandwidths by nested cross-validation, harder splits and
  /// further schemes. Without it there is no headline.
  bool beyond_the_paper = true;
  /// Taxel of the figures of single responses. If it is outside the matrix: the taxel of median RMSE% in
  /// method 1.
  std::size_t figure_taxel = static_cast<std::size_t>(-1);
  std::uint64_t seed = 1;
  unsigned threads = 0;  ///< 0 = one for each core; the numbers do not depend on it
  std::string date;      ///< ISO 8601, UTC; empty = now
};

/// Throws InputError that names the field out of range. `origin` is the file name for messages.
void validate(const StudyPlan& plan, const std::string& origin);

/// Reads a file of config/study. Unknown keys are errors. All keys but `study` are optional:
///
///     study: paper
///     sections: 5
///     down_sampling: random        # every_nth, contiguous
///     method_4: full_flat          # half_and_half
///     range: held_out              # all
///     grnn: {bandwidth: 0.0078125, spread: sigma, distance: squared}   # spread: half; distance: literal
///     forest: {trees: 150, minimum_leaf: 5}
///     tests: {level: 0.05, normality_of: treatments}                   # differences
///     bandwidths: [0.0009765625, 0.001953125]
///     bandwidth_taxels: 10
///     resamples: 1999
///     beyond_the_paper: true
///     figure_taxel: 34
///     seed: 1
///
/// Throws InputError.
StudyPlan readStudyPlan(const settings::Settings& settings);
StudyPlan readStudyPlanFile(const std::string& path);

}  // namespace fsr::study
