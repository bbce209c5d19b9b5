// Fits with Gram matrices: a column that acts only on bent surfaces together with one that acts everywhere.

#include "statistics/signed_least_squares.h"

#include <gtest/gtest.h>

#include <cmath>

namespace fsr::statistics {
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

Eigen::VectorXd solved(const Eigen::MatrixXd& x, const Eigen::VectorXd& target,
                       const std::vector<bool>& free) {
  return solveSigned(x.transpose() * x, x.transpose() * target, free);
}

TEST(SolveSigned, FitsAColumnThatActsWhereItIsBentBesideOneThatActsEverywhere) {
  const Eigen::MatrixXd all = columns();
  const Eigen::VectorXd target = all.col(2);
  Eigen::MatrixXd x = all.leftCols(2);
  x.col(1).head(kMoments).setZero();
  const Eigen::VectorXd fitted = solved(x, target, {true, true});
  EXPECT_NEAR(fitted[0], 1.5, 1e-7);
  EXPECT_NEAR(fitted[1], 0.7, 1e-7);
  const Eigen::VectorXd left = target - x * fitted;
  EXPECT_NEAR(left.head(kMoments).squaredNorm(), 0, 1e-9);
  EXPECT_NEAR(left.tail(kMoments).squaredNorm(), 0, 1e-9);
  const Eigen::MatrixXd wrong = all.leftCols(2);
  EXPECT_GT((target - wrong * solved(wrong, target, {true, true})).squaredNorm(), 0.5);
}

TEST(SolveSigned, KeepsTheSignThatIsNotFree) {
  const Eigen::MatrixXd x = columns().leftCols(1);
  const Eigen::VectorXd reversed = -columns().col(2);
  EXPECT_EQ(solved(x, reversed, {false})[0], 0);
  EXPECT_LT(solved(x, reversed, {true})[0], 0);
}

}  // namespace
}  // namespace fsr::statistics
