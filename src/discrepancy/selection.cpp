#include "fsr_pressure_map/discrepancy/selection.h"

#include <cmath>
#include <limits>

namespace fsr {

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// Square of what columns with these coefficients make.
double squareOf(const Eigen::MatrixXd& gram, const ColumnSet& set, const Eigen::VectorXd& coefficients) {
  double square = 0;
  for (std::size_t i = 0; i < set.columns.size(); ++i) {
    const double b = coefficients[static_cast<Eigen::Index>(i)];
    if (b == 0) continue;
    for (std::size_t j = 0; j < set.columns.size(); ++j) {
      square += b * coefficients[static_cast<Eigen::Index>(j)] * gram(set.columns[i], set.columns[j]);
    }
  }
  return square;
}

}  // namespace

Selection::Selection(const Measured& measured, const CycleGrams& grams) : measured_(measured), grams_(grams) {
  std::vector<bool> wanted(measured.cycles.size());
  for (std::uint32_t fold = 0; fold <= Measured::kFolds; ++fold) {
    for (std::size_t c = 0; c < wanted.size(); ++c) {
      wanted[c] = measured.cycles[c].use == CycleUse::kFit && measured.cycles[c].fold != fold;
    }
    if (fold < Measured::kFolds) without_fold_.push_back(grams.sum(wanted));
    if (fold == Measured::kFolds) all_ = grams.sum(wanted);
  }
  nothing_ = score(ColumnSet{});
}

Score Selection::score(const ColumnSet& set) const {
  Score score;
  score.set = set;
  for (const Eigen::MatrixXd& gram : without_fold_) score.of_fold.push_back(fitColumns(gram, set));
  for (std::size_t c = 0; c < measured_.cycles.size(); ++c) {
    const MeasuredCycle& cycle = measured_.cycles[c];
    const bool shows = cycle.use == CycleUse::kShow;
    score.error.push_back(shows ? kNaN : squaredError(grams_.of(c), set, score.of_fold[cycle.fold]));
    if (!shows) score.total += score.error.back();
  }
  score.coefficients = fitColumns(all_, set);
  return score;
}

Score Selection::score(const Score& with, const Family& family) const {
  Score best;
  best.total = std::numeric_limits<double>::infinity();
  for (const ColumnSet& alternative : family.alternatives) {
    Score now = score(together(with.set, alternative));
    if (now.total < best.total) best = now;
  }
  best.ids = with.ids;
  best.ids.push_back(family.id);
  return best;
}

double Selection::share(const Score& before, const Score& after) {
  return before.total > 0 ? (before.total - after.total) / before.total : 0;
}

double Selection::z(const Score& before, const Score& after) const {
  const ColumnSet both = together(after.set, before.set);
  double sum = 0, squares = 0;
  for (std::size_t c = 0; c < before.error.size(); ++c) {
    const double gained = before.error[c] - after.error[c];
    if (std::isnan(gained)) continue;
    const std::uint32_t fold = measured_.cycles[c].fold;
    Eigen::VectorXd difference(after.of_fold[fold].size() + before.of_fold[fold].size());
    difference << after.of_fold[fold], -before.of_fold[fold];
    sum += gained;
    squares += std::pow((gained - squareOf(grams_.of(c), both, difference)) / 2, 2);
  }
  return squares > 0 ? sum / (2 * std::sqrt(squares)) : 0;
}

}  // namespace fsr
