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
  for (const MeasuredCycle& cycle : measured.cycles) {
    bent_.push_back(!isFlat(measured.classes[measured.visits[cycle.visit].curvature_class]));
  }
  std::vector<bool> wanted(measured.cycles.size());
  for (const bool bent_only : {false, true}) {
    for (std::uint32_t fold = 0; fold <= Measured::kFolds; ++fold) {
      for (std::size_t c = 0; c < wanted.size(); ++c) {
        wanted[c] = measured.cycles[c].use == CycleUse::kFit && measured.cycles[c].fold != fold &&
                    (bent_[c] || !bent_only);
      }
      sums_[bent_only].push_back(grams.sum(wanted));
    }
  }
  nothing_ = score(ColumnSet{});
}

Score Selection::score(const ColumnSet& set) const {
  Score score;
  score.set = set;
  for (const Eigen::MatrixXd& gram : sums_[set.bent_only]) score.of_fold.push_back(fitColumns(gram, set));
  score.coefficients = score.of_fold.back();
  for (std::size_t c = 0; c < measured_.cycles.size(); ++c) {
    const MeasuredCycle& cycle = measured_.cycles[c];
    const Eigen::MatrixXd& gram = grams_.of(c);
    const bool acts = bent_[c] || !set.bent_only;
    const double error =
        acts ? squaredError(gram, set, score.of_fold[cycle.fold]) : gram(gram.rows() - 1, gram.rows() - 1);
    score.error.push_back(cycle.use == CycleUse::kShow ? kNaN : error);
    if (cycle.use == CycleUse::kFit) score.total += error;
  }
  return score;
}

Score Selection::score(const Score& with, const Family& family) const {
  Score best;
  best.total = std::numeric_limits<double>::infinity();
  for (const ColumnSet& alternative : family.alternatives) {
    const bool fits = with.set.columns.empty() || with.set.bent_only == alternative.bent_only;
    if (!fits) continue;
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

double Selection::acts(const Score& score, std::size_t cycle) const {
  return bent_[cycle] || !score.set.bent_only ? 1 : 0;
}

double Selection::z(const Score& before, const Score& after) const {
  const ColumnSet both = together(after.set, before.set);
  double sum = 0, squares = 0;
  for (std::size_t c = 0; c < before.error.size(); ++c) {
    const double gained = before.error[c] - after.error[c];
    if (std::isnan(gained)) continue;
    const std::uint32_t fold = measured_.cycles[c].fold;
    Eigen::VectorXd difference(after.of_fold[fold].size() + before.of_fold[fold].size());
    difference << after.of_fold[fold] * acts(after, c), -before.of_fold[fold] * acts(before, c);
    sum += gained;
    squares += std::pow((gained - squareOf(grams_.of(c), both, difference)) / 2, 2);
  }
  return squares > 0 ? sum / (2 * std::sqrt(squares)) : 0;
}

}  // namespace fsr
