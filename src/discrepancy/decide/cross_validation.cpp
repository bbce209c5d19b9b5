#include "discrepancy/decide/cross_validation.h"

#include <cmath>
#include <limits>

namespace fsr::discrepancy {

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

}  // namespace

CrossValidation::CrossValidation(const Measured& measured, const CycleGrams& grams)
    : measured_(measured), grams_(grams) {
  for (const MeasuredCycle& cycle : measured.cycles) {
    flat_.push_back(dataset::isFlat(measured.classes[measured.visits[cycle.visit].curvature_class]));
  }
  std::vector<bool> wanted(measured.cycles.size());
  for (const bool flat : {false, true}) {
    for (std::uint32_t fold = 0; fold <= Measured::kFolds; ++fold) {
      for (std::size_t c = 0; c < wanted.size(); ++c) {
        wanted[c] =
            measured.cycles[c].use == CycleUse::kFit && measured.cycles[c].fold != fold && flat_[c] == flat;
      }
      sums_[flat].push_back(grams.sum(wanted));
    }
  }
  nothing_ = score(ColumnSet{});
}

Score CrossValidation::score(const ColumnSet& set) const {
  Score score;
  score.set = set;
  for (std::size_t fold = 0; fold < sums_[0].size(); ++fold) {
    const Eigen::MatrixXd part = partOf(sums_[0][fold], set, false) + partOf(sums_[1][fold], set, true);
    score.of_fold.push_back(fitColumns(part, set));
  }
  score.coefficients = score.of_fold.back();
  for (std::size_t c = 0; c < measured_.cycles.size(); ++c) {
    const MeasuredCycle& cycle = measured_.cycles[c];
    const bool held_out = cycle.use == CycleUse::kHoldOut;
    score.error.push_back(
        held_out ? kNaN : squaredError(partOf(grams_.of(c), set, flat_[c]), score.of_fold[cycle.fold]));
    if (!held_out) score.total += score.error.back();
  }
  return score;
}

Score CrossValidation::score(const Score& with, const Family& family) const {
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

double CrossValidation::share(const Score& before, const Score& after) {
  return before.total > 0 ? (before.total - after.total) / before.total : 0;
}

double CrossValidation::z(const Score& before, const Score& after) const {
  const ColumnSet both = together(after.set, before.set);
  double sum = 0, squares = 0;
  for (std::size_t c = 0; c < before.error.size(); ++c) {
    const double gained = before.error[c] - after.error[c];
    if (std::isnan(gained)) continue;
    const std::uint32_t fold = measured_.cycles[c].fold;
    Eigen::VectorXd difference(after.of_fold[fold].size() + before.of_fold[fold].size());
    difference << after.of_fold[fold], -before.of_fold[fold];
    const Eigen::Index size = difference.size();
    const Eigen::MatrixXd part = partOf(grams_.of(c), both, flat_[c]).topLeftCorner(size, size);
    sum += gained;
    squares += std::pow((gained - difference.dot(part * difference)) / 2, 2);
  }
  return squares > 0 ? sum / (2 * std::sqrt(squares)) : 0;
}

}  // namespace fsr::discrepancy
