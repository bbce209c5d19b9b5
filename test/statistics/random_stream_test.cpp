#include "statistics/random_stream.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace {

using fsr::statistics::normalQuantile;
using fsr::statistics::RandomStream;
using fsr::statistics::randomStream;

// SplitMix64 with seed 1234567, as published by its authors.
TEST(RandomStream, GivesTheNumbersOfSplitMix64) {
  const RandomStream stream(1234567);
  EXPECT_EQ(stream.bits(0), 6457827717110365317u);
  EXPECT_EQ(stream.bits(1), 3203168211198807973u);
  EXPECT_EQ(stream.bits(4), 16408922859458223821u);
}

// from scipy.stats import norm; [repr(norm.ppf(p)) for p in (...)]  (SciPy 1.10.1)
TEST(RandomStream, NormalQuantileAgreesWithSciPy) {
  const std::vector<std::pair<double, double>> known = {{0.5, 0.0},
                                                        {0.6, 0.2533471031357997},
                                                        {0.05, -1.6448536269514729},
                                                        {0.95, 1.6448536269514722},
                                                        {0.9, 1.2815515655446004},
                                                        {0.001, -3.090232306167813},
                                                        {0.999, 3.090232306167813},
                                                        {1e-10, -6.361340902404056},
                                                        {1e-16, -8.222082216130435},
                                                        {0.3, -0.5244005127080409},
                                                        {1e-300, -37.0470962993612}};
  for (const auto& [p, z] : known) EXPECT_NEAR(normalQuantile(p), z, 1e-14 * (1 + std::abs(z))) << p;
}

TEST(RandomStream, NormalNumbersHaveTheirDistribution) {
  const RandomStream stream = randomStream(1, "test");
  constexpr int kDraws = 200000;
  std::vector<double> draws;
  for (int i = 0; i < kDraws; ++i) draws.push_back(stream.normal(i));
  double mean = 0, square = 0, lag = 0;
  for (int i = 0; i < kDraws; ++i) {
    mean += draws[i] / kDraws;
    square += draws[i] * draws[i] / kDraws;
    lag += draws[i] * draws[(i + 1) % kDraws] / kDraws;
  }
  // Five standard errors of each estimate.
  EXPECT_NEAR(mean, 0, 5 / std::sqrt(kDraws));
  EXPECT_NEAR(square, 1, 5 * std::sqrt(2.0 / kDraws));
  EXPECT_NEAR(lag, 0, 5 / std::sqrt(kDraws));
  // Kolmogorov-Smirnov: P(sqrt(n) D > 1.95) = 0.001.
  std::sort(draws.begin(), draws.end());
  double distance = 0;
  for (int i = 0; i < kDraws; ++i) {
    const double cdf = 0.5 * std::erfc(-draws[i] / std::sqrt(2.0));
    distance =
        std::max({distance, std::abs(cdf - double(i) / kDraws), std::abs(cdf - double(i + 1) / kDraws)});
  }
  EXPECT_LT(std::sqrt(kDraws) * distance, 1.95);
}

TEST(RandomStream, PurposesMembersAndSeedsAreIndependent) {
  const std::vector<RandomStream> streams = {randomStream(1, "noise", 0), randomStream(1, "noise", 1),
                                             randomStream(1, "gain", 0), randomStream(2, "noise", 0)};
  constexpr int kDraws = 20000;
  for (std::size_t a = 0; a < streams.size(); ++a) {
    for (std::size_t b = a + 1; b < streams.size(); ++b) {
      double covariance = 0;
      for (int i = 0; i < kDraws; ++i) covariance += streams[a].normal(i) * streams[b].normal(i) / kDraws;
      EXPECT_NEAR(covariance, 0, 5 / std::sqrt(kDraws)) << a << " and " << b;
    }
  }
}

TEST(RandomStream, GivesTheSameNumbersInAnyOrder) {
  const RandomStream one = randomStream(7, "x", 3), other = randomStream(7, "x", 3);
  const double last = one.normal(1000);
  EXPECT_EQ(other.normal(0), one.normal(0));
  EXPECT_EQ(other.normal(1000), last);
}

}  // namespace
