#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>

namespace fsr::regression {

/// The paper's bandwidth: sigma of the kernel in standard deviations of the training readings
/// (Ahmadizadeh and Menon 2019, doi:10.3390/s19245519).
constexpr double kPaperBandwidth = 1.0 / 128.0;

/// What the number called bandwidth (or spread) means.
enum class SpreadMeaning {
  kSigma,  ///< sigma of the Gaussian
  kHalf,   ///< MATLAB's newgrnn: the distance at which the kernel is 0.5, sigma = 0.8493 spread
};

/// The exponent of the kernel. D is the distance between readings.
enum class KernelDistance {
  kSquared,  ///< -D^2 / 2 sigma^2, as in Specht's GRNN
  kLiteral,  ///< -D / 2 sigma^2, as the paper's sentence reads ("D_j^2 is the Euclidean distance")
};

/// The weight of each training sample.
enum class SampleWeighting {
  kEachSample,       ///< equal weights: the answer is biased towards pressures that the chamber held long
  kEachPressureBin,  ///< every bin of training pressure has the same total weight (see pressure_grid.h)
};

/// Options of the GRNN (general regression neural network).
struct GrnnOptions {
  double bandwidth = kPaperBandwidth;  ///< standard deviations of the readings, 1e-6 to 1000
  SpreadMeaning spread = SpreadMeaning::kSigma;
  KernelDistance distance = KernelDistance::kSquared;
  SampleWeighting weighting = SampleWeighting::kEachSample;
};

/// What to do when the input drawn for a node cannot split it: all its values are equal, or every cut would
/// leave too few readings on one side. Libraries differ and do not document it.
enum class InputSampling {
  kRetry,  ///< try the other input; scikit-learn is similar, but retries constant inputs only
  kLeaf,   ///< make the node a leaf, as ranger does
};

/// What the minimum leaf size counts. A reading that was drawn twice is two draws. Libraries differ; the
/// choice changes RMSE% by about 0.06.
enum class LeafCount {
  kDraws,     ///< draws: MATLAB, ranger, dlib, whose trees grow on a resampled copy of the data
  kDistinct,  ///< different readings: scikit-learn, which weights readings instead of repeating them
};

/// Options of the random forest. The defaults are the paper's, with MATLAB's conventions (TreeBagger and
/// fitrensemble 'Bag', regression).
struct ForestOptions {
  std::size_t trees = 150;       ///< 1 to 100,000
  std::size_t minimum_leaf = 5;  ///< at least 1
  LeafCount leaf_count = LeafCount::kDraws;
  InputSampling sampling = InputSampling::kRetry;
  std::uint64_t seed = 1;
};

struct RegressorTable;

/// The regressor to train, with the options of each.
struct RegressorOptions {
  std::string name = "grnn";  ///< "linear", "grnn", "forest", "monotone", or a name in `table`
  GrnnOptions grnn = {};
  ForestOptions forest = {};
  /// Options of any other regressor, by name.
  std::map<std::string, double> more = {};
  /// Where `name` is looked up; null = the regressors of this package. The table must outlive the options.
  const RegressorTable* table = nullptr;
};

}  // namespace fsr::regression
