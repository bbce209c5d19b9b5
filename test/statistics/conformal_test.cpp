#include "statistics/conformal.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace fsr::statistics {
namespace {

TEST(Conformal, NeedsNineteenUnitsFor95Percent) {
  EXPECT_EQ(conformalUnits(0.95), 19u);
  EXPECT_EQ(conformalUnits(0.6827), 3u);
  EXPECT_FALSE(conformalRank(18, 0.95));
  EXPECT_EQ(conformalRank(19, 0.95), 19u);   // ceil(20 x 0.95)
  EXPECT_EQ(conformalRank(39, 0.95), 38u);   // ceil(40 x 0.95)
  EXPECT_EQ(conformalRank(10, 0.6827), 8u);  // ceil(11 x 0.6827)
  EXPECT_FALSE(conformalRank(0, 0.5));
}

// python3 -c "from scipy.stats import binom; print(repr(binom.sf(17, 19, .9)))", scipy 1.10.1
TEST(Conformal, EqualProbabilitiesGiveTheBinomialOfScipy) {
  EXPECT_NEAR(probabilityOfAtLeast(18, std::vector<double>(19, 0.9)), 0.42026497883159786, 1e-12);
  EXPECT_NEAR(probabilityOfAtLeast(0, std::vector<double>(19, 0.9)), 1.0, 1e-12);
}

// 0.9 x 0.5 x 0.2 = 0.09 for all three; two of them 0.9 x 0.5 x 0.8 + 0.9 x 0.5 x 0.2 + 0.1 x 0.5 x 0.2.
TEST(Conformal, UnequalProbabilitiesAreCountedOut) {
  EXPECT_NEAR(probabilityOfAtLeast(3, {0.9, 0.5, 0.2}), 0.09, 1e-12);
  EXPECT_NEAR(probabilityOfAtLeast(2, {0.9, 0.5, 0.2}), 0.09 + 0.36 + 0.09 + 0.01, 1e-12);
  EXPECT_EQ(probabilityOfAtLeast(2, {0.9}), 0.0);
}

// python3 -c "from scipy.stats import beta; print(beta.ppf([.05, .5, .95], 20, 1), beta.ppf([.05, .5, .95],
// 15, 6))"
TEST(Conformal, StatesTheCoverThatTheNumberOfUnitsGives) {
  const auto most = conformalCover(20, 0.95);
  ASSERT_TRUE(most);
  EXPECT_EQ(most->rank, 20u);
  EXPECT_DOUBLE_EQ(most->mean, 20.0 / 21);
  EXPECT_NEAR(most->low, 0.86089166, 1e-8);
  EXPECT_NEAR(most->median, 0.96593633, 1e-8);
  EXPECT_NEAR(most->high, 0.99743863, 1e-8);
  const auto middle = conformalCover(20, 0.6827);
  ASSERT_TRUE(middle);
  EXPECT_EQ(middle->rank, 15u);
  EXPECT_NEAR(middle->median, 0.72119545, 1e-8);
  EXPECT_FALSE(conformalCover(18, 0.95));
}

// Where each unit has one score, the threshold is the k-th smallest score: plain split-conformal.
TEST(Conformal, OneScoreAUnitGivesTheOrderStatistic) {
  const auto shares = [](std::size_t i) {
    std::vector<double> of_units;
    for (std::size_t unit = 0; unit < 19; ++unit) of_units.push_back(unit * 5 <= i ? 1.0 : 0.0);
    return of_units;
  };
  EXPECT_EQ(conformalThreshold(19, 0.95, 100, shares), 90u);    // the largest of 0, 5, ..., 90
  EXPECT_EQ(conformalThreshold(19, 0.6827, 100, shares), 65u);  // the 14th
  EXPECT_FALSE(conformalThreshold(18, 0.95, 100, shares));
}

// A reading is the size of its unit plus its own: the share of new units' readings within the interval is
// near the level, whichever of the two is larger.
TEST(Conformal, CoversNewUnits) {
  constexpr std::size_t kCells = 400, kUnits = 24, kReadings = 60, kTrials = 300;
  std::mt19937 draw(7);
  std::normal_distribution<double> normal;
  for (const double own : {0.2, 1.0, 5.0}) {
    const double cell = std::hypot(1.0, own) * 6 / kCells;
    double covered = 0;
    for (std::size_t trial = 0; trial < kTrials; ++trial) {
      const auto unit = [&] {
        const double common = normal(draw);
        std::vector<double> shares(kCells, 0.0);
        for (std::size_t i = 0; i < kReadings; ++i) {
          const auto place = static_cast<std::size_t>(std::abs(common + own * normal(draw)) / cell);
          shares[std::min(place, kCells - 1)] += 1.0 / kReadings;
        }
        for (std::size_t i = 1; i < kCells; ++i) shares[i] += shares[i - 1];
        return shares;
      };
      std::vector<std::vector<double>> units;
      for (std::size_t u = 0; u < kUnits; ++u) units.push_back(unit());
      const auto threshold = conformalThreshold(kUnits, 0.95, kCells, [&](std::size_t i) {
        std::vector<double> shares;
        for (const auto& of_unit : units) shares.push_back(of_unit[i]);
        return shares;
      });
      ASSERT_TRUE(threshold);
      for (int fresh = 0; fresh < 5; ++fresh) covered += unit()[*threshold] / 5;
    }
    EXPECT_NEAR(covered / kTrials, 0.955, 0.02) << own;
  }
}

}  // namespace
}  // namespace fsr::statistics
