#include "calibration/stages/memory/history_fit.h"

#include <algorithm>
#include <cmath>

#include "calibration/stages/memory/history_state.h"
#include "statistics/signed_least_squares.h"

namespace fsr::calibration {

namespace {

constexpr std::size_t kKnots = 17;
// Of the plays, shares of the range. A loop of a smooth form needs no more: twice as many changed the error
// on other protocols by less than 4 %.
constexpr double kRadii[] = {0.02, 0.05, 0.1, 0.2, 0.35};
constexpr std::size_t kMostMemories = 6;
constexpr double kShortest = 0.3;         // time constant [s]
constexpr double kShareOfHold = 1.0 / 3;  // the longest time constant
constexpr std::size_t kContinued = 2;     // memories of the decade beyond it
constexpr double kRidge = 1e-5;           // of each weight, relative to the squares of its feature
constexpr double kContinues = 0.1;        // of differences of weights, relative to the mean of the squares
constexpr double kMatters = 1e-4;         // share of the range

using Index = Eigen::Index;

bool hasPlays(HistoryFamily family) {
  return family == HistoryFamily::kPlays || family == HistoryFamily::kBoth;
}

bool hasMemories(HistoryFamily family) {
  return family == HistoryFamily::kMemories || family == HistoryFamily::kBoth;
}

// The columns of the grid that a family uses, each with the sign that its coefficient must have; 0 = either.
struct Columns {
  std::vector<Index> index;
  std::vector<double> sign;
  Index memories = 0, continued = 0;  // of the last columns
};

Columns columnsOf(HistoryFamily family, const HistoryGrid& grid, double plays, double memories) {
  Columns columns;
  const auto add = [&](std::size_t first, std::size_t count, double sign) {
    for (std::size_t k = first; k < first + count; ++k) {
      columns.index.push_back(Index(k));
      columns.sign.push_back(sign);
    }
  };
  add(0, grid.knots.size(), 0);
  if (hasPlays(family)) add(grid.knots.size(), grid.radii.size(), plays);
  if (!hasMemories(family)) return columns;
  add(grid.knots.size() + grid.radii.size(), grid.time_constants.size(), memories);
  columns.memories = Index(grid.time_constants.size());
  columns.continued = Index(grid.continued);
  return columns;
}

Eigen::VectorXd fitColumns(const Columns& columns, const HistorySums& sums) {
  const Index n = Index(columns.index.size()), target = sums.gram().rows() - 1;
  Eigen::MatrixXd gram(n, n);
  Eigen::VectorXd right(n);
  std::vector<bool> free;
  const auto sign = [&](Index i) {
    const double own = columns.sign[std::size_t(i)];
    return own == 0 ? 1.0 : own;
  };
  for (Index i = 0; i < n; ++i) {
    const Index from = columns.index[std::size_t(i)];
    free.push_back(columns.sign[std::size_t(i)] == 0);
    right[i] = sign(i) * sums.gram()(from, target);
    for (Index j = 0; j < n; ++j)
      gram(i, j) = sign(i) * sign(j) * sums.gram()(from, columns.index[std::size_t(j)]);
    if (!free.back()) gram(i, i) *= 1 + kRidge;
  }
  if (columns.continued > 0) {
    const double strength = kContinues * gram.diagonal().tail(columns.memories).mean();
    for (Index i = n - columns.continued; i < n; ++i) {
      gram(i, i) += strength, gram(i - 1, i - 1) += strength;
      gram(i, i - 1) -= strength, gram(i - 1, i) -= strength;
    }
  }
  const Eigen::VectorXd own = statistics::solveSigned(gram, right, free);
  Eigen::VectorXd all = Eigen::VectorXd::Zero(target);
  for (Index i = 0; i < n; ++i) all[columns.index[std::size_t(i)]] = sign(i) * own[i];
  return all;
}

EvenPlace placeOn(const HistoryGrid& grid, double x) {
  const double per_unit = double(grid.knots.size() - 1) / (grid.knots.back() - grid.knots.front());
  return EvenLine::place(x, grid.knots.front(), per_unit, grid.knots.size());
}

}  // namespace

HistoryGrid historyGrid(double lowest, double highest, double longest_hold) {
  HistoryGrid grid;
  const double range = std::max(highest - lowest, 1.0);
  for (std::size_t k = 0; k < kKnots; ++k)
    grid.knots.push_back(lowest + range * double(k) / double(kKnots - 1));
  for (const double share : kRadii) grid.radii.push_back(share * range);
  const double longest = std::max(kShortest, kShareOfHold * longest_hold);
  // At least a factor of two apart.
  const std::size_t count =
      std::min(kMostMemories, 1 + static_cast<std::size_t>(std::log2(longest / kShortest)));
  for (std::size_t k = 0; k < count; ++k) {
    const double share = count == 1 ? 0 : double(k) / double(count - 1);
    grid.time_constants.push_back(kShortest * std::pow(longest / kShortest, share));
  }
  grid.continued = count == 1 ? 0 : kContinued;
  for (std::size_t k = 1; k <= grid.continued; ++k)
    grid.time_constants.push_back(longest * std::pow(10.0, double(k) / double(kContinued)));
  return grid;
}

HistoryOperators operatorsOf(const HistoryGrid& grid) {
  return HistoryOperators(grid.radii, grid.time_constants, grid.knots.back());
}

void historyFeatures(const HistoryGrid& grid, double x, const double* state, double* features) {
  const std::size_t knots = grid.knots.size();
  std::fill(features, features + knots, 0.0);
  const EvenPlace at = placeOn(grid, x);
  features[at.below] = 1 - at.share;
  features[at.below + 1] = at.share;
  for (std::size_t k = knots; k < grid.features(); ++k) features[k] = state[k - knots] - x;
}

void HistorySums::add(const double* features, double target) {
  const Index n = rows_.rows() - 1;
  rows_.col(waiting_).head(n) = Eigen::Map<const Eigen::VectorXd>(features, n);
  rows_(n, waiting_) = target;
  samples_ += 1;
  if (++waiting_ == kBlock) addBlock();
}

void HistorySums::addBlock() {
  if (waiting_ == 0) return;
  gram_.noalias() += rows_.leftCols(waiting_) * rows_.leftCols(waiting_).transpose();
  waiting_ = 0;
}

void HistorySums::finish() {
  addBlock();
  rows_.resize(rows_.rows(), 0);
}

void HistorySums::merge(const HistorySums& other) {
  gram_ += other.gram_;
  samples_ += other.samples_;
}

double HistorySums::meanSquare(const Eigen::VectorXd& coefficients) const {
  const Index n = gram_.rows() - 1;
  const double sum = gram_(n, n) - 2 * coefficients.dot(gram_.col(n).head(n)) +
                     coefficients.dot(gram_.topLeftCorner(n, n) * coefficients);
  return std::max(0.0, sum) / samples_;
}

Eigen::VectorXd fitCorrection(const HistoryGrid& grid, const HistorySums& sums) {
  return fitColumns(columnsOf(HistoryFamily::kNone, grid, 0, 0), sums);
}

Eigen::VectorXd fitHistory(HistoryFamily family, const HistoryGrid& grid, const HistorySums& sums) {
  Eigen::VectorXd best = Eigen::VectorXd::Zero(Index(grid.features()));
  if (family == HistoryFamily::kNone) return best;
  double least = sums.meanSquare(best);
  for (const double plays : {-1.0, 1.0}) {
    if (plays > 0 && !hasPlays(family)) continue;
    for (const double memories : {-1.0, 1.0}) {
      if (memories > 0 && !hasMemories(family)) continue;
      const Eigen::VectorXd own = fitColumns(columnsOf(family, grid, plays, memories), sums);
      const double square = sums.meanSquare(own);
      if (square < least) best = own, least = square;
    }
  }
  return best;
}

std::vector<double> memorySpreads(const HistoryGrid& grid, const HistorySums& sums) {
  const Index first = Index(grid.knots.size() + grid.radii.size());
  std::vector<double> spreads;
  for (Index k = 0; k < Index(grid.time_constants.size()); ++k)
    spreads.push_back(std::sqrt(sums.gram()(first + k, first + k) / std::max(sums.samples(), 1.0)));
  return spreads;
}

void ChangeRange::add(double x, double change) {
  const EvenPlace at = placeOn(*grid_, x);
  const std::size_t knot = at.below + (at.share > 0.5 ? 1 : 0);
  least_[knot] = std::min(least_[knot], change);
  largest_[knot] = std::max(largest_[knot], change);
}

void ChangeRange::merge(const ChangeRange& other) {
  for (std::size_t k = 0; k < least_.size(); ++k) {
    least_[k] = std::min(least_[k], other.least_[k]);
    largest_[k] = std::max(largest_[k], other.largest_[k]);
  }
}

void ChangeRange::finish() {
  const auto take = [this](std::size_t to, std::size_t from) {
    if (least_[to] > largest_[to]) least_[to] = least_[from], largest_[to] = largest_[from];
  };
  for (std::size_t k = 1; k < least_.size(); ++k) take(k, k - 1);
  for (std::size_t k = least_.size() - 1; k-- > 0;) take(k, k + 1);
}

double ChangeRange::limited(double x, double change) const {
  const EvenPlace at = placeOn(*grid_, x);
  return std::min(std::max(change, EvenLine::between(least_, at)), EvenLine::between(largest_, at));
}

HistoryModel historyModel(HistoryFamily family, const HistoryGrid& grid, const Eigen::VectorXd& coefficients,
                          const std::vector<double>& spreads) {
  HistoryModel model;
  model.family = family;
  if (!model.present()) return model;
  const double range = grid.knots.back() - grid.knots.front();
  model.knot = grid.knots;
  Index at = 0;
  for (std::size_t k = 0; k < grid.knots.size(); ++k) model.correction.push_back(coefficients[at++]);
  for (const double radius : grid.radii) {
    const double weight = coefficients[at++];
    if (std::abs(weight) * radius < kMatters * range) continue;
    model.radius.push_back(radius);
    model.play_weight.push_back(weight);
  }
  for (std::size_t k = 0; k < grid.time_constants.size(); ++k) {
    const double weight = coefficients[at++];
    if (std::abs(weight) < kMatters) continue;
    model.time_constant.push_back(grid.time_constants[k]);
    model.memory_spread.push_back(spreads[k]);
    model.memory_weight.push_back(weight);
  }
  return model;
}

}  // namespace fsr::calibration
