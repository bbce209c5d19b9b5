#include "regression/grnn/gaussian_table.h"

#include <cmath>
#include <cstring>

#include "regression/grnn/vector_width.h"

namespace fsr::regression {

namespace {

constexpr std::ptrdiff_t kVectorLanes = 8;
constexpr std::ptrdiff_t kVectors = kCodeBlock / kVectorLanes;
constexpr double kSmallestKernel = 700.0;  // exponent
using Lanes = double __attribute__((vector_size(kVectorLanes * sizeof(double))));

// `kernel` points to distance 0. Code i of the block is at distance block + i - code from a sample.
FSR_EACH_VECTOR_WIDTH
void addSamples(const WeightedCodes& samples, std::size_t first, std::size_t last, const double* kernel,
                double* block_sums, double* block_weights) {
  Lanes sums[kVectors] = {};
  Lanes weights[kVectors] = {};
  for (std::size_t s = first; s < last; ++s) {
    const double* const values = kernel - samples.code[s];
    for (std::ptrdiff_t v = 0; v < kVectors; ++v) {
      Lanes lanes;
      std::memcpy(&lanes, values + v * kVectorLanes, sizeof(lanes));
      sums[v] += samples.sum[s] * lanes;
      weights[v] += samples.count[s] * lanes;
    }
  }
  std::memcpy(block_sums, sums, sizeof(sums));
  std::memcpy(block_weights, weights, sizeof(weights));
}

}  // namespace

GaussianTable::GaussianTable(double sigma, std::ptrdiff_t radius)
    : radius_(radius), values_(static_cast<std::size_t>(2 * (radius + kCodeBlock) + 1)) {
  const std::ptrdiff_t side = radius + kCodeBlock;
  const double precision = 0.5 / (sigma * sigma);
  for (std::ptrdiff_t d = 0; d <= side; ++d) {
    const double exponent = precision * static_cast<double>(d * d);
    const double value = exponent < kSmallestKernel ? std::exp(-exponent) : 0.0;  // avoids denormal numbers
    values_[static_cast<std::size_t>(side - d)] = values_[static_cast<std::size_t>(side + d)] = value;
  }
}

void GaussianTable::sumBlock(const WeightedCodes& samples, std::size_t first, std::size_t last,
                             std::ptrdiff_t block, double* sums, double* weights) const {
  addSamples(samples, first, last, values_.data() + radius_ + kCodeBlock + block, sums, weights);
}

}  // namespace fsr::regression
