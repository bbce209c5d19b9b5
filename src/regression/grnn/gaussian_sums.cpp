#include "regression/grnn/gaussian_sums.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

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

namespace {

// Sums at the codes of a block, and the present power of the `step` of each code.
struct OuterSums {
  OuterSums() { power.fill(1.0); }
  std::array<double, kCodeBlock> step{}, power, pressure{}, weight{};
};

FSR_EACH_VECTOR_WIDTH
void multiply(const double* factor, double* value) {
  for (std::size_t i = 0; i < kCodeBlock; ++i) value[i] *= factor[i];
}

FSR_EACH_VECTOR_WIDTH
void addOuter(double pressure, double weight, OuterSums& sums) {
  for (std::size_t i = 0; i < kCodeBlock; ++i) {
    sums.pressure[i] += pressure * sums.power[i];
    sums.weight[i] += weight * sums.power[i];
  }
}

}  // namespace

void FarGaussian::sumBlock(std::ptrdiff_t begin, std::ptrdiff_t end, KernelMean& mean) {
  const std::vector<std::int32_t>& code = samples_.code;
  if (!code.empty() && (end <= code.front() || begin > code.back())) {
    sumBeyondAll(begin, end, mean);
  } else {
    for (std::ptrdiff_t i = begin; i < end; ++i) sumCode(i, mean);
  }
}

// Starts with the nearest code.
void FarGaussian::sumBeyondAll(std::ptrdiff_t begin, std::ptrdiff_t end, KernelMean& mean) {
  const bool below = end <= samples_.code.front();
  const std::ptrdiff_t edge = below ? samples_.code.front() : samples_.code.back();
  const std::ptrdiff_t nearest = below ? edge - (end - 1) : begin - edge;
  OuterSums sums;
  sums.step = stepPowers();
  const double per_step = std::exp(-2 * precision_ * static_cast<double>(nearest));
  for (double& step : sums.step) step *= per_step;
  std::ptrdiff_t beyond = 0;
  for (std::size_t i = 0; i < samples_.code.size(); ++i) {
    const std::size_t s = below ? i : samples_.code.size() - 1 - i;
    const std::ptrdiff_t j = std::abs(samples_.code[s] - edge);
    if (static_cast<double>((2 * nearest + j) * j) > beyond_nearest_) break;
    for (; beyond < j; ++beyond) multiply(sums.step.data(), sums.power.data());
    addOuter(samples_.sum[s] * shared(j), samples_.count[s] * shared(j), sums);
  }
  for (std::ptrdiff_t i = 0; i < end - begin; ++i) {
    const auto place = static_cast<std::size_t>(i);
    store(below ? end - 1 - i : begin + i, static_cast<double>(nearest + i),
          {sums.pressure[place], sums.weight[place]}, mean);
  }
}

// For codes within a gap between samples or beside one.
void FarGaussian::sumCode(std::ptrdiff_t code, KernelMean& mean) {
  const std::size_t right = samples_.firstFrom(code);
  const bool on_left = right > 0, on_right = right < samples_.code.size();
  const double to_left = on_left ? static_cast<double>(code - samples_.code[right - 1]) : INFINITY;
  const double to_right = on_right ? static_cast<double>(samples_.code[right] - code) : INFINITY;
  const double nearest = std::min(to_left, to_right);
  Sums sums;
  if (on_left) addSide(to_left, nearest, static_cast<std::ptrdiff_t>(right) - 1, -1, sums);
  if (on_right) addSide(to_right, nearest, static_cast<std::ptrdiff_t>(right), 1, sums);
  store(code, nearest, sums, mean);
}

void FarGaussian::store(std::ptrdiff_t code, double nearest, Sums sums, KernelMean& mean) const {
  const double exponent = precision_ * nearest * nearest;
  mean.pressure[static_cast<std::size_t>(code)] = sums.pressure / sums.weight;
  mean.weight[static_cast<std::size_t>(code)] =
      exponent < kLargestKernelExponent ? sums.weight * std::exp(-exponent) : 0.0;
  if (log_weight_ == LogWeight::kNo) return;
  mean.log_weight[static_cast<std::size_t>(code)] = std::log(sums.weight) - exponent;
}

void FarGaussian::addSide(double distance, double nearest, std::ptrdiff_t first, std::ptrdiff_t step,
                          Sums& sums) {
  const double ahead = distance * distance - nearest * nearest;
  if (ahead > beyond_nearest_) return;
  const double per_step = std::exp(-2 * precision_ * distance);
  double power = std::exp(-precision_ * ahead);
  std::ptrdiff_t beyond = 0;  // the first sample [counts]
  const auto number = static_cast<std::ptrdiff_t>(samples_.code.size());
  for (std::ptrdiff_t s = first; s >= 0 && s < number; s += step) {
    const auto sample = static_cast<std::size_t>(s);
    const std::ptrdiff_t j = std::abs(samples_.code[sample] - samples_.code[static_cast<std::size_t>(first)]);
    const auto gap = static_cast<double>(j);
    if (ahead + (2 * distance + gap) * gap > beyond_nearest_) return;
    for (; beyond < j; ++beyond) power *= per_step;
    const double value = power * shared(j);
    sums.pressure += samples_.sum[sample] * value;
    sums.weight += samples_.count[sample] * value;
  }
}

double FarGaussian::shared(std::ptrdiff_t j) {
  for (auto i = shared_.size(); i <= static_cast<std::size_t>(j); ++i) {
    shared_.push_back(std::exp(-precision_ * static_cast<double>(i * i)));
  }
  return shared_[static_cast<std::size_t>(j)];
}

const FarGaussian::BlockValues& FarGaussian::stepPowers() {
  if (step_powers_) return *step_powers_;
  step_powers_.emplace();
  for (std::size_t i = 0; i < step_powers_->size(); ++i) {
    (*step_powers_)[i] = std::exp(-2 * precision_ * static_cast<double>(i));
  }
  return *step_powers_;
}

namespace {

constexpr std::size_t kNodes =
    16;  // a point is interpolated from 7 nodes before its cell's first node to 8 after it
constexpr int kFirstNode = -7;
constexpr double kNodesPerSigma = 10;  // with 16 nodes the error is 1.1e-15, found with long double
constexpr double kWidestCell = 512;    // [codes]

std::size_t spacingFor(double sigma) {
  return static_cast<std::size_t>(std::min(sigma / kNodesPerSigma, kWidestCell));
}

// For each node the product of its distances to the others: i! (15 - i)!, with sign.
std::array<double, kNodes> distanceProducts() {
  std::array<double, kNodes> products;
  for (std::size_t i = 0; i < kNodes; ++i) {
    products[i] = 1;
    for (std::size_t k = 0; k < kNodes; ++k) {
      if (k != i) products[i] *= static_cast<double>(i) - static_cast<double>(k);
    }
  }
  return products;
}

// Lagrange weights of the sixteen nodes at a point of the cell 0 .. 1: for each node the product of the
// distances of the point to all other nodes, below and above it.
std::array<double, kNodes> lagrangeWeights(double at, const std::array<double, kNodes>& products) {
  std::array<double, kNodes> weights;
  double below = 1, above = 1;
  for (std::size_t i = 0; i < kNodes; ++i) {
    weights[i] = below / products[i];
    below *= at - (kFirstNode + static_cast<int>(i));
  }
  for (std::size_t i = kNodes; i-- > 0;) {
    weights[i] *= above;
    above *= at - (kFirstNode + static_cast<int>(i));
  }
  return weights;
}

// to[i] += sum of taps[j] from[i + j]: sixteen products in a fixed order.
FSR_EACH_VECTOR_WIDTH
void addTaps(const double* taps, const double* from, std::size_t number, double* to) {
  for (std::size_t i = 0; i < number; ++i) {
    double sum = to[i];
    for (std::size_t j = 0; j < kNodes; ++j) sum += taps[j] * from[i + j];
    to[i] = sum;
  }
}

// Applies the kernel from node to node.
void convolve(WeightedCodes& grid, double sigma, double reach) {
  const auto nodes = static_cast<std::ptrdiff_t>(grid.table_size);
  const double radius = std::min(reach + kNodes, static_cast<double>(nodes));
  const GaussianTable kernel(sigma, static_cast<std::ptrdiff_t>(radius));
  const std::size_t padded = grid.table_size + kCodeBlock;
  std::vector<double> sum(padded), weight(padded);
  for (std::ptrdiff_t block = 0; block < nodes; block += kCodeBlock) {
    const auto first = static_cast<std::size_t>(std::max<std::ptrdiff_t>(block - kernel.radius(), 0));
    const auto last = static_cast<std::size_t>(std::min(block + kCodeBlock + kernel.radius(), nodes));
    kernel.sumBlock(grid, first, last, block, &sum[static_cast<std::size_t>(block)],
                    &weight[static_cast<std::size_t>(block)]);
  }
  grid.sum = std::move(sum);
  grid.count = std::move(weight);
}

}  // namespace

bool CoarseGrid::suits(double sigma) {
  return spacingFor(sigma) >= 2;
}

CoarseGrid::CoarseGrid(const WeightedCodes& samples, double sigma, double reach)
    : spacing_(spacingFor(sigma)), cells_(samples.table_size / spacing_ + 1) {
  const auto products = distanceProducts();
  for (std::size_t offset = 0; offset < spacing_; ++offset) {
    const double at = static_cast<double>(offset) / static_cast<double>(spacing_);
    const auto weights = lagrangeWeights(at, products);
    lagrange_.insert(lagrange_.end(), weights.begin(), weights.end());
  }
  WeightedCodes grid;
  grid.table_size = cells_ + kNodes - 1;
  grid.code.resize(grid.table_size);
  std::iota(grid.code.begin(), grid.code.end(), 0);
  const std::vector<std::size_t> places = placesOf(samples);
  grid.sum = toNodes(places, samples.sum);
  grid.count = toNodes(places, samples.count);
  const auto spacing = static_cast<double>(spacing_);
  convolve(grid, sigma / spacing, reach / spacing);
  sum_ = toCodes(grid.sum);
  weight_ = toCodes(grid.count);
}

// Position of each sample among the cells. Samples at the same offset are adjacent, with fifteen empty cells
// on either side.
std::vector<std::size_t> CoarseGrid::placesOf(const WeightedCodes& samples) const {
  std::vector<std::size_t> places(samples.code.size());
  std::size_t cell = 0, cell_begin = 0;
  for (std::size_t s = 0; s < places.size(); ++s) {
    const auto code = static_cast<std::size_t>(samples.code[s]);
    for (; code >= cell_begin + spacing_; cell_begin += spacing_) ++cell;  // faster than a division
    places[s] = (code - cell_begin) * paddedCells() + cell + kNodes - 1;
  }
  return places;
}

std::size_t CoarseGrid::paddedCells() const {
  return cells_ + 2 * (kNodes - 1);
}

// Node n of the result is node n - 7 of the grid.
std::vector<double> CoarseGrid::toNodes(const std::vector<std::size_t>& places,
                                        const std::vector<double>& values) const {
  const std::size_t row = paddedCells();
  std::vector<double> by_offset(spacing_ * row), nodes(cells_ + kNodes - 1);
  for (std::size_t s = 0; s < places.size(); ++s) by_offset[places[s]] = values[s];
  for (std::size_t offset = 0; offset < spacing_; ++offset) {
    std::array<double, kNodes> taps;  // weight i of cell n - i contributes to node n
    std::reverse_copy(&lagrange_[offset * kNodes], &lagrange_[(offset + 1) * kNodes], taps.begin());
    addTaps(taps.data(), &by_offset[offset * row], nodes.size(), nodes.data());
  }
  return nodes;
}

CoarseGrid::CellValues CoarseGrid::toCodes(const std::vector<double>& nodes) const {
  CellValues values(spacing_ * cells_);
  for (std::size_t offset = 0; offset < spacing_; ++offset) {
    addTaps(&lagrange_[offset * kNodes], nodes.data(), cells_, &values[offset * cells_]);
  }
  return values;
}

void CoarseGrid::sumCodes(std::ptrdiff_t begin, std::ptrdiff_t end, double* sums, double* weights) const {
  std::size_t cell = static_cast<std::size_t>(begin) / spacing_,
              offset = static_cast<std::size_t>(begin) % spacing_;
  for (std::ptrdiff_t code = begin; code < end; ++code) {
    *sums++ = sum_[offset * cells_ + cell];
    *weights++ = weight_[offset * cells_ + cell];
    if (++offset == spacing_) {
      offset = 0;
      ++cell;
    }
  }
}

}  // namespace fsr::regression
