#include "dataset/time_series.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace fsr::dataset {
namespace {

constexpr std::int64_t kLongestGap = 2'000'000'000;  // [ns]

std::int64_t ns(double seconds) {
  return 1'700'000'000'000'000'000 + std::llround(seconds * 1e9);
}

TimeSeries series(const std::vector<double>& times, const std::vector<double>& values) {
  TimeSeries result;
  for (std::size_t i = 0; i < times.size(); ++i) result.add(ns(times[i]), values[i]);
  result.sort();
  return result;
}

double at(const TimeSeries& series, double time) {
  return series.between(ns(time), kLongestGap).value_or(NAN);
}

// Expected values: SciPy 1.10.1, with t and v the numbers of the test,
//   from scipy.interpolate import PchipInterpolator as P; [repr(x) for x in P(t, v)(at)]
TEST(TimeSeries, InterpolatesAsSciPyDoes) {
  const TimeSeries reference = series({0, 1, 2, 2.5, 4, 5, 6, 7.5, 8}, {0, 0, 3, 5, 6, 6, 2, -1, 0});
  const std::vector<double> times = {0.25, 0.9, 1.5, 2.2, 3.1, 4.5, 5.3, 6.7, 7.9};
  const std::vector<double> expected = {0.0,
                                        0.0,
                                        1.064516129032258,
                                        3.89256843940715,
                                        5.632216216216216,
                                        6.0,
                                        5.307818181818182,
                                        0.1067474747474742,
                                        -0.29599999999999893};
  for (std::size_t i = 0; i < times.size(); ++i) EXPECT_NEAR(at(reference, times[i]), expected[i], 1e-12);
  EXPECT_EQ(at(reference, 2.5), 5);
  EXPECT_NEAR(at(series({0, 2}, {1, 5}), 0.5), 2.0, 1e-12);
  EXPECT_NEAR(at(series({0, 1, 2}, {0, 1, 8}), 0.5), 0.28125, 1e-12);
  EXPECT_NEAR(at(series({0, 1, 2}, {0, 1, -8}), 0.5), 0.875, 1e-12);
}

TEST(TimeSeries, StraightIsTheLineBetweenTheNeighbours) {
  const TimeSeries reference = series({0, 2, 3}, {1, 5, 0});
  EXPECT_NEAR(reference.straight(ns(0.5), kLongestGap).value(), 2, 1e-12);
  EXPECT_EQ(reference.straight(ns(2), kLongestGap), 5);
  EXPECT_FALSE(reference.straight(ns(0.5), kLongestGap / 2));
}

// A chamber that fills exponentially in 10 s, read once in 2 s. The largest error of linear interpolation is
// 2^2 / 8 / 10^2 = 0.5 % of the final pressure times exp(-t / 10 s).
TEST(TimeSeries, FollowsAnExponentialFillingBetweenRareReadings) {
  const auto filling = [](double time) { return 600e3 * -std::expm1(-time / 10); };
  TimeSeries reference;
  for (int i = 0; i <= 20; ++i) reference.add(ns(2 * i), filling(2 * i));
  reference.sort();
  double largest = 0;
  for (double time = 2; time <= 38; time += 0.1)
    largest = std::max(largest, std::abs(at(reference, time) - filling(time)));
  EXPECT_LT(largest, 0.0005 * 600e3);
}

TEST(TimeSeries, NeverLeavesTheRangeOfItsTwoNeighbours) {
  const std::vector<double> values = {0, 0, 600e3, 600e3, 599e3, 10, 10.1, 0, 7, 7};
  std::vector<double> times;
  for (std::size_t i = 0; i < values.size(); ++i)
    times.push_back(0.37 * static_cast<double>(i * i % 7 + 7 * i) / 7);
  const TimeSeries reference = series(times, values);
  for (std::size_t i = 0; i + 1 < values.size(); ++i) {
    for (double share = 0.05; share < 1; share += 0.05) {
      const double value = at(reference, times[i] + share * (times[i + 1] - times[i]));
      EXPECT_GE(value, std::min(values[i], values[i + 1]));
      EXPECT_LE(value, std::max(values[i], values[i + 1]));
    }
  }
}

TEST(TimeSeries, ValuesBeyondAGapHaveNoInfluence) {
  const TimeSeries alone = series({0, 1, 2}, {0, 1, 4});
  const TimeSeries gaps = series({-3, 0, 1, 2, 4.5}, {50, 0, 1, 4, 90});
  for (const double time : {0.3, 0.8, 1.4, 1.9}) EXPECT_EQ(at(gaps, time), at(alone, time));
  EXPECT_TRUE(std::isnan(at(gaps, -1)));
  EXPECT_TRUE(std::isnan(at(gaps, 3)));
}

TEST(TimeSeries, OfSeveralValuesAtOneStampTheSmallestCounts) {
  const TimeSeries once = series({0, 1, 2}, {0, 1, 4});
  const TimeSeries twice = series({2, 1, 0, 1, 2}, {4, 1, 0, 3, 9});
  EXPECT_EQ(twice.size(), 3u);
  for (const double time : {0.3, 1.0, 1.4}) EXPECT_EQ(at(twice, time), at(once, time));
}

TEST(TimeSeries, TheNearestEndIsHeldOutside) {
  const TimeSeries reference = series({0, 10}, {1, 3});
  EXPECT_EQ(reference.nearby(ns(-5)), 1);
  EXPECT_EQ(reference.nearby(ns(15)), 3);
  EXPECT_NEAR(reference.nearby(ns(5)), 2, 1e-12);
}

}  // namespace
}  // namespace fsr::dataset
