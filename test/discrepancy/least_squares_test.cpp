// Fits with gram matrices: columns that act only on bent surfaces together with columns that act everywhere.

#include "discrepancy/fit/least_squares.h"

#include <gtest/gtest.h>

#include <cmath>

namespace fsr::discrepancy {
namespace {

constexpr Eigen::Index kMoments = 40;

// Two columns and a target. The target is 1.5 of the first column everywhere plus 0.7 of the second where the
// surface is bent. The first cycle is flat.
Eigen::MatrixXd columns() {
  Eigen::MatrixXd all(2 * kMoments, 3);
  for (Eigen::Index i = 0; i < all.rows(); ++i) {
    const double t = static_cast<double>(i);
    all(i, 0) = std::sin(0.3 * t);
    all(i, 1) = std::cos(0.2 * t) + 0.4 * std::sin(0.3 * t);
    all(i, 2) = 1.5 * all(i, 0) + (i < kMoments ? 0 : 0.7 * all(i, 1));
  }
  return all;
}

TEST(ColumnSet, MayHoldAColumnThatActsWhereItIsBentBesideOneThatActsEverywhere) {
  const CycleGrams grams(columns(), {{0, kMoments}, {kMoments, 2 * kMoments}}, 1);
  const ColumnSet everywhere{{0}, {true}, {false}}, bent{{1}, {true}, {true}};
  const ColumnSet both = together(everywhere, bent);
  const Eigen::MatrixXd flat_part = partOf(grams.of(0), both, true),
                        bent_part = partOf(grams.of(1), both, false);
  const Eigen::VectorXd fitted = fitColumns(flat_part + bent_part, both);
  EXPECT_NEAR(fitted[0], 1.5, 1e-7);
  EXPECT_NEAR(fitted[1], 0.7, 1e-7);
  EXPECT_NEAR(squaredError(flat_part, fitted), 0, 1e-9);
  EXPECT_NEAR(squaredError(bent_part, fitted), 0, 1e-9);
  const ColumnSet wrong{{0, 1}, {true, true}, {false, false}};
  const Eigen::MatrixXd all = partOf(grams.of(0), wrong, true) + partOf(grams.of(1), wrong, false);
  EXPECT_GT(squaredError(all, fitColumns(all, wrong)), 0.5);
}

TEST(ColumnSet, KeepsTheSignThatIsNotFree) {
  const CycleGrams grams(-columns(), {{0, 2 * kMoments}}, 1);
  Eigen::MatrixXd part = partOf(grams.of(0), {{0}, {false}, {false}}, false);
  part(0, 1) = part(1, 0) = -part(0, 1);  // the sign of the target is reversed
  EXPECT_EQ(fitColumns(part, {{0}, {false}, {false}})[0], 0);
  EXPECT_LT(fitColumns(part, {{0}, {true}, {false}})[0], 0);
}

}  // namespace
}  // namespace fsr::discrepancy
