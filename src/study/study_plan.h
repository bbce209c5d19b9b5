#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "regression/forest/forest.h"
#include "regression/grnn/grnn.h"
#include "fsr_pressure_map/settings/settings.h"
#include "regression/bandwidth_search.h"
#include "statistics/paper_rule.h"

namespace fsr::study {

/// Which scans stay where a method takes one of n. The paper does not say.
enum class DownSampling {
  kRandom,      ///< drawn without replacement
  kEveryNth,    ///< the first of every n
  kContiguous,  ///< one run of neighbours, at a place drawn at random
};

/// "random", "every_nth", "contiguous".
std::string downSamplingName(DownSampling down_sampling);

/// Range of pressure that RMSE% refers to. The paper does not say.
enum class ScoreRange {
  kHeldOut,  ///< of the readings that are scored
  kAll,      ///< of all scans
};

/// What method 4 takes of the data; "similar to method 3" leaves it open.
enum class BinaryShare {
  kFullFlat,     ///< the whole flat condition, one in five of the curved ones
  kHalfAndHalf,  ///< half of each, as many as one condition has
};

/// Everything that the study decides where the paper leaves a choice, and how much it computes.
struct StudyPlan {
  std::string name = "paper";
  std::size_t sections = 5;  ///< of each condition, held out in turn
  DownSampling down_sampling = DownSampling::kRandom;
  BinaryShare binary_share = BinaryShare::kFullFlat;
  ScoreRange range = ScoreRange::kHeldOut;
  regression::GrnnOptions grnn;      ///< of the reproduction; its bandwidth is the paper's 2^-7
  regression::ForestOptions forest;  ///< its seed is derived from the study's
  statistics::PaperRuleOptions tests;
  /// Bandwidths of the grid, and of the choice by nested cross-validation.
  std::vector<double> bandwidths = regression::bandwidthGrid();
  /// What a whole method learns (bandwidth, length scale, ranges) is learned on every n-th taxel, n such that
  /// about so many are seen, and holds for all.
  std::size_t bandwidth_taxels = 10;
  std::size_t resamples = 1999;  ///< of the bootstrap
  /// Whether to go beyond the paper: all scans, bandwidths by nested cross-validation, harder splits, further
  /// schemes. Without it there is no headline, and figures of single predictions show five sections.
  bool beyond_the_paper = true;
  /// Taxel that the figures of single responses show; beyond the matrix: the one of median RMSE% in
  /// method 1.
  std::size_t figure_taxel = static_cast<std::size_t>(-1);
  std::uint64_t seed = 1;
  unsigned threads = 0;  ///< 0 = one for each core; changes no number
  std::string date;      ///< ISO 8601, UTC; empty = now
};

/// Throws InputError that names what is out of range; `origin` stands where messages name the file.
void validate(const StudyPlan& plan, const std::string& origin);

/// Reads config/study/*.yaml strictly. Form, all but `study` may be left out:
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
