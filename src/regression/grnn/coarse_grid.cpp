#include "regression/grnn/coarse_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "regression/grnn/gaussian_table.h"
#include "regression/grnn/vector_width.h"

namespace fsr::regression {

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
