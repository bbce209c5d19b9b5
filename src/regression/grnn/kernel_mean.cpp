#include "regression/grnn/kernel_mean.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>

#include "regression/grnn/gaussian_sums.h"
#include "regression/grnn/vector_width.h"

namespace fsr::regression {

namespace {

// The coarse grid is used where its error, a share of the samples within reach, is this far below their
// weight, and where a sample is so near that the samples it leaves out do not matter.
constexpr double kLeastShareOfWeight = 0.01;
constexpr double kFarthestOnGrid = 3.0;  // [sigma]
constexpr double kNoGap = 0.5;           // [sigma]

FSR_EACH_VECTOR_WIDTH
void divide(const double* numerator, const double* denominator, std::ptrdiff_t number, double* quotient) {
  for (std::ptrdiff_t i = 0; i < number; ++i) quotient[i] = numerator[i] / denominator[i];
}

double leastOf(const double* values, std::size_t number) {
  std::array<double, 8> lane;
  lane.fill(INFINITY);
  std::size_t i = 0;
  for (; i + lane.size() <= number; i += lane.size()) {
    for (std::size_t k = 0; k < lane.size(); ++k) lane[k] = std::min(lane[k], values[i + k]);
  }
  for (; i < number; ++i) lane[0] = std::min(lane[0], values[i]);
  return *std::min_element(lane.begin(), lane.end());
}

class GaussianSums {
 public:
  GaussianSums(const WeightedCodes& samples, double sigma, LogWeight log_weight, KernelMean& mean)
      : samples_(samples),
        log_weight_(log_weight),
        codes_(static_cast<std::ptrdiff_t>(samples.table_size)),
        sigma_(sigma),
        precision_(0.5 / (sigma * sigma)),
        beyond_nearest_(std::log(samples.samples / kNegligibleShare) / precision_),
        mean_(mean),
        far_(samples, precision_, beyond_nearest_, log_weight) {}

  void run() {
    findFarthest();
    if (CoarseGrid::suits(sigma_)) prepareGrid();
    for (std::ptrdiff_t block = 0; block < codes_; block += kCodeBlock) {
      const std::ptrdiff_t end = std::min(block + kCodeBlock, codes_);
      const double far = farthest_[static_cast<std::size_t>(block / kCodeBlock)];
      if (gridBlock(block, end, far)) continue;
      if (isNear(far)) {
        directBlock(block, end, far);
      } else {
        far_.sumBlock(block, end, mean_);
      }
    }
  }

 private:
  // Distance within which samples count at a code whose nearest sample is `nearest` away [counts].
  double reach(double nearest) const {
    return std::min(std::sqrt(nearest * nearest + beyond_nearest_), static_cast<double>(codes_));
  }

  // Whether no kernel value that counts at such a code underflows.
  bool isNear(double nearest) const {
    return precision_ * (nearest * nearest + beyond_nearest_) <= kLargestKernelExponent;
  }

  // Largest distance of a code to its nearest sample, for each block. Distances below `kNoGap` do not
  // lengthen the reach and are set to it.
  void findFarthest() {
    const double no_gap = kNoGap * sigma_;
    farthest_.assign(static_cast<std::size_t>((codes_ + kCodeBlock - 1) / kCodeBlock), no_gap);
    const auto narrow = static_cast<std::ptrdiff_t>(std::min(2 * no_gap, static_cast<double>(codes_))) + 1;
    std::ptrdiff_t before = -codes_;
    for (const std::int32_t after : samples_.code) {
      if (after - before > narrow) noteGap(before, after);
      before = after;
    }
    noteGap(before, 2 * codes_);
  }

  void noteGap(std::ptrdiff_t before, std::ptrdiff_t after) {
    const std::ptrdiff_t first = std::max<std::ptrdiff_t>(before + 1, 0), last = std::min(after, codes_) - 1;
    for (std::ptrdiff_t begin = first; begin <= last; begin = (begin / kCodeBlock + 1) * kCodeBlock) {
      const std::ptrdiff_t end = std::min(begin / kCodeBlock * kCodeBlock + kCodeBlock - 1, last);
      const std::ptrdiff_t middle = std::clamp((before + after) / 2, begin, end);
      double& farthest = farthest_[static_cast<std::size_t>(begin / kCodeBlock)];
      farthest = std::max(farthest, static_cast<double>(std::min(middle - before, after - middle)));
    }
  }

  void prepareGrid() {
    const double grid_reach = reach(kFarthestOnGrid * sigma_);
    grid_.emplace(samples_, sigma_, grid_reach);
    grid_reach_ = static_cast<std::ptrdiff_t>(grid_reach);
  }

  // Number of samples within the reach of the grid from some code of the block.
  double weightWithinReach(std::ptrdiff_t block, std::ptrdiff_t end) {
    if (count_before_.empty()) {
      count_before_.assign(samples_.count.size() + 1, 0.0);
      std::partial_sum(samples_.count.begin(), samples_.count.end(), count_before_.begin() + 1);
    }
    return count_before_[samples_.firstFrom(end + grid_reach_)] -
           count_before_[samples_.firstFrom(block - grid_reach_)];
  }

  void store(std::ptrdiff_t block, std::ptrdiff_t end, const double* sums, const double* weights) {
    divide(sums, weights, end - block, &mean_.pressure[static_cast<std::size_t>(block)]);
    std::copy(weights, weights + (end - block), mean_.weight.begin() + block);
    if (log_weight_ != LogWeight::kYes) return;
    std::transform(weights, weights + (end - block), mean_.log_weight.begin() + block,
                   [](double weight) { return std::log(weight); });
  }

  bool gridBlock(std::ptrdiff_t block, std::ptrdiff_t end, double far) {
    if (!grid_ || far > kFarthestOnGrid * sigma_) return false;
    std::array<double, kCodeBlock> sums, weights;
    grid_->sumCodes(block, end, sums.data(), weights.data());
    const double least = leastOf(weights.data(), static_cast<std::size_t>(end - block));
    if (least < kLeastShareOfWeight * samples_.samples &&
        least < kLeastShareOfWeight * weightWithinReach(block, end)) {
      return false;
    }
    store(block, end, sums.data(), weights.data());
    return true;
  }

  void directBlock(std::ptrdiff_t block, std::ptrdiff_t end, double far) {
    if (!table_) {
      double farthest = 0;
      for (const double other : farthest_) farthest = isNear(other) ? std::max(farthest, other) : farthest;
      table_.emplace(sigma_, static_cast<std::ptrdiff_t>(reach(farthest)));
    }
    const auto side = static_cast<std::ptrdiff_t>(reach(far));
    std::array<double, kCodeBlock> sums, weights;
    table_->sumBlock(samples_, samples_.firstFrom(block - side), samples_.firstFrom(end + side), block,
                     sums.data(), weights.data());
    store(block, end, sums.data(), weights.data());
  }

  const WeightedCodes& samples_;
  LogWeight log_weight_;
  std::ptrdiff_t codes_;
  double sigma_;
  double precision_;       // 1 / 2 sigma^2 [1/counts^2]
  double beyond_nearest_;  // 2 sigma^2 ln(N / negligible) [counts^2]
  KernelMean& mean_;
  std::vector<double> farthest_;  // of each block [counts]
  std::ptrdiff_t grid_reach_ = 0;
  std::optional<CoarseGrid> grid_;
  std::vector<double> count_before_;  // of all samples before each
  std::optional<GaussianTable> table_;
  FarGaussian far_;
};

}  // namespace

KernelMean gaussianMean(const WeightedCodes& samples, double sigma, LogWeight log_weight) {
  KernelMean mean{std::vector<double>(samples.table_size), std::vector<double>(samples.table_size),
                  std::vector<double>(log_weight == LogWeight::kNo ? 0 : samples.table_size)};
  GaussianSums(samples, sigma, log_weight, mean).run();
  return mean;
}

namespace {

// Sums over the samples on one side of a code, relative to the nearest of them.
struct Side {
  double sum = 0, weight = 0;
  double distance = INFINITY;  // of the code to that nearest one [counts]
};

// The side of every code, by one pass over the codes: between samples only the distance changes. `step` is 1
// for the samples at or below a code, -1 for those above it.
std::vector<Side> sides(const WeightedCodes& samples, double length, int step) {
  const auto codes = static_cast<std::ptrdiff_t>(samples.table_size);
  std::vector<Side> sides(samples.table_size);
  Side side;
  auto next = step > 0 ? std::size_t{0} : samples.code.size() - 1;  // wraps around at the end
  for (std::ptrdiff_t code = step > 0 ? 0 : codes - 1; code >= 0 && code < codes; code += step) {
    if (step < 0) sides[static_cast<std::size_t>(code)] = side;
    if (next < samples.code.size() && samples.code[next] == code) {
      const double decay = std::exp(-side.distance / length);
      side = {side.sum * decay + samples.sum[next], side.weight * decay + samples.count[next], 0.0};
      next += static_cast<std::size_t>(step);
    }
    if (step > 0) sides[static_cast<std::size_t>(code)] = side;
    side.distance += 1;
  }
  return sides;
}

}  // namespace

KernelMean laplaceMean(const WeightedCodes& samples, double length, LogWeight log_weight) {
  const std::vector<Side> below = sides(samples, length, 1), above = sides(samples, length, -1);
  KernelMean mean{std::vector<double>(samples.table_size), std::vector<double>(samples.table_size), {}};
  for (std::size_t code = 0; code < samples.table_size; ++code) {
    const double nearest = std::min(below[code].distance, above[code].distance);
    const double low = std::exp(-(below[code].distance - nearest) / length);
    const double high = std::exp(-(above[code].distance - nearest) / length);
    const double weight = below[code].weight * low + above[code].weight * high;
    mean.pressure[code] = (below[code].sum * low + above[code].sum * high) / weight;
    mean.weight[code] = weight * std::exp(-nearest / length);
    if (log_weight == LogWeight::kYes) mean.log_weight.push_back(std::log(weight) - nearest / length);
  }
  return mean;
}

}  // namespace fsr::regression
