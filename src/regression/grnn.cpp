#include "fsr_pressure_map/regression/grnn.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <sstream>

#include "fsr_pressure_map/regression/vector_width.h"
#include "fsr_pressure_map/regression/weighted_codes.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "fsr_pressure_map/settings/range.h"

namespace fsr {

namespace {

const Range kBandwidthRange{1e-6, 1e3, "standard deviations of the readings"};
// Share of the pressure range that all left-out samples together may move an answer by.
constexpr double kNegligible = 1e-14;
// Codes that one pass of the inner loop answers, so many that their sums stay in registers.
constexpr std::ptrdiff_t kLanes = 8;
constexpr std::ptrdiff_t kVectors = 4;
constexpr std::ptrdiff_t kBlock = kLanes * kVectors;
using Lanes = double __attribute__((vector_size(kLanes * sizeof(double))));
// Kernel values down to exp(-600) are kept: far from the smallest double, so that quotients of sums
// of them keep full precision.
constexpr double kLargestExponent = 600.0;

// Distance of each code to the nearest one that occurs [counts].
std::vector<std::ptrdiff_t> distances(const WeightedCodes& samples, std::size_t codes) {
  std::vector<std::ptrdiff_t> distance(codes, static_cast<std::ptrdiff_t>(codes));
  for (const std::ptrdiff_t code : samples.code) distance[static_cast<std::size_t>(code)] = 0;
  for (std::size_t c = 1; c < codes; ++c) distance[c] = std::min(distance[c], distance[c - 1] + 1);
  for (std::size_t c = codes - 1; c > 0; --c) distance[c - 1] = std::min(distance[c - 1], distance[c] + 1);
  return distance;
}

// sums[i] += sum * kernel[i], weights[i] += count * kernel[i] for each sample of [first, last);
// `kernel` points to distance 0, and code i of the block lies at distance block + i - code.
FSR_EACH_VECTOR_WIDTH
void addBlock(const WeightedCodes& samples, std::size_t first, std::size_t last, const double* kernel,
              std::ptrdiff_t block, double* block_sums, double* block_weights) {
  Lanes sums[kVectors] = {};
  Lanes weights[kVectors] = {};
  for (std::size_t s = first; s < last; ++s) {
    const double* const values = kernel + (block - samples.code[s]);
    for (std::ptrdiff_t v = 0; v < kVectors; ++v) {
      Lanes lanes;
      std::memcpy(&lanes, values + v * kLanes, sizeof(lanes));
      sums[v] += samples.sum[s] * lanes;
      weights[v] += samples.count[s] * lanes;
    }
  }
  std::memcpy(block_sums, sums, sizeof(sums));
  std::memcpy(block_weights, weights, sizeof(weights));
}

class Convolution {
 public:
  Convolution(const WeightedCodes& samples, double sigma)
      : samples_(samples),
        distance_(distances(samples_, samples.table_size)),
        precision_(0.5 / (sigma * sigma)),
        exponent_(std::log(samples.samples / kNegligible)) {
    const double largest = std::sqrt(kLargestExponent / precision_);
    radius_ = static_cast<std::ptrdiff_t>(std::min(largest, static_cast<double>(distance_.size())));
    const std::ptrdiff_t side = radius_ + kBlock;
    kernel_.resize(static_cast<std::size_t>(2 * side + 1));
    for (std::ptrdiff_t d = 0; d <= side; ++d) {
      kernel_[static_cast<std::size_t>(side - d)] = kernel_[static_cast<std::size_t>(side + d)] =
          unshifted(d);
    }
  }

  Fit run() const {
    const auto codes = static_cast<std::ptrdiff_t>(distance_.size());
    Fit fit{std::vector<double>(distance_.size()), std::vector<double>(distance_.size())};
    for (std::ptrdiff_t block = 0; block < codes; block += kBlock) {
      const std::ptrdiff_t end = std::min(block + kBlock, codes);
      const std::ptrdiff_t farthest = *std::max_element(distance_.begin() + block, distance_.begin() + end);
      if (reach(farthest) <= radius_) {
        fastBlock(block, end, reach(farthest), fit);
      } else {
        for (std::ptrdiff_t code = block; code < end; ++code) farCode(code, fit);
      }
    }
    return fit;
  }

 private:
  double unshifted(std::ptrdiff_t d) const { return std::exp(-precision_ * static_cast<double>(d * d)); }

  // How far the samples lie that count at a code whose nearest sample is `nearest` away:
  // d^2 <= d_min^2 + 2 sigma^2 ln(N / negligible).
  std::ptrdiff_t reach(std::ptrdiff_t nearest) const {
    const double square = static_cast<double>(nearest * nearest) + exponent_ / precision_;
    return static_cast<std::ptrdiff_t>(std::min(std::sqrt(square), static_cast<double>(distance_.size())));
  }

  std::size_t firstFrom(std::ptrdiff_t code) const {
    return static_cast<std::size_t>(std::lower_bound(samples_.code.begin(), samples_.code.end(), code) -
                                    samples_.code.begin());
  }

  // Codes [block, end), all of them near enough to a sample that no shift is needed.
  void fastBlock(std::ptrdiff_t block, std::ptrdiff_t end, std::ptrdiff_t far, Fit& fit) const {
    double sums[kBlock];
    double weights[kBlock];
    const double* const centre = kernel_.data() + radius_ + kBlock;
    addBlock(samples_, firstFrom(block - far), firstFrom(end + far), centre, block, sums, weights);
    for (std::ptrdiff_t code = block; code < end; ++code) {
      fit.pressure[static_cast<std::size_t>(code)] = sums[code - block] / weights[code - block];
      fit.support[static_cast<std::size_t>(code)] = weights[code - block];
    }
  }

  // A code so far from every sample that only quotients of kernel values can be formed.
  void farCode(std::ptrdiff_t code, Fit& fit) const {
    const std::ptrdiff_t nearest = distance_[static_cast<std::size_t>(code)];
    const std::ptrdiff_t far = reach(nearest);
    const std::size_t last = firstFrom(code + far + 1);
    double sum = 0, weight = 0;
    for (std::size_t s = firstFrom(code - far); s < last; ++s) {
      const std::ptrdiff_t d = samples_.code[s] - code;
      const double value = std::exp(-precision_ * static_cast<double>(d * d - nearest * nearest));
      sum += samples_.sum[s] * value;
      weight += samples_.count[s] * value;
    }
    fit.pressure[static_cast<std::size_t>(code)] = sum / weight;
    fit.support[static_cast<std::size_t>(code)] = weight * unshifted(nearest);
  }

  const WeightedCodes& samples_;
  std::vector<std::ptrdiff_t> distance_;
  double precision_;  // 1 / 2 sigma^2 [1/counts^2]
  double exponent_;   // ln(N / negligible)
  std::ptrdiff_t radius_ = 0;
  std::vector<double> kernel_;  // exp(-d^2 / 2 sigma^2), d = -(radius + block) .. radius + block
};

}  // namespace

Grnn::Grnn(double bandwidth) : bandwidth_(bandwidth) {
  if (!kBandwidthRange.contains(bandwidth)) {
    std::ostringstream text;
    text << "bandwidth is " << bandwidth << ", but must be " << kBandwidthRange.text();
    throw InputError(text.str());
  }
}

Fit Grnn::fit(const CodeHistogram& training) const {
  const WeightedCodes samples = weightedCodes(training);
  const double deviation = readingDeviation(training);
  if (deviation == 0) return constantFit(samples);
  return Convolution(samples, bandwidth_ * deviation).run();
}

}  // namespace fsr
