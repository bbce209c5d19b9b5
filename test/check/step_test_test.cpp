#include "check/sheet_life.h"

#include <gtest/gtest.h>

#include <cmath>

#include "statistics/random_stream.h"

namespace fsr::check {
namespace {

using statistics::randomStream;
using statistics::RandomStream;

std::vector<double> days(std::size_t count) {
  std::vector<double> time;
  for (std::size_t i = 0; i < count; ++i) time.push_back(7.0 * static_cast<double>(i));
  return time;
}

// A line with scatter of one unit.
std::vector<double> course(std::uint64_t seed, std::size_t count, double slope_per_day = 0) {
  const RandomStream stream = randomStream(seed, "course");
  std::vector<double> y;
  for (std::size_t i = 0; i < count; ++i)
    y.push_back(100 + slope_per_day * 7.0 * static_cast<double>(i) + stream.normal(i));
  return y;
}

// numpy, with the quantile t(0.995, 3) = 5.840909309733 of scipy 1.10 (stats.t.ppf):
//   t = array([0,7,14,28,35.]); y = array([1,1.02,.99,1.01,1]); X = c_[ones(5),t]; b = lstsq(X,y)[0]; x =
//   array([1,49.]) r = y-X@b; x@b, 5.840909309733*sqrt(r@r/3*(1+x@inv(X.T@X)@x))  ->  1.001860465116279
//   0.1194499610920537
TEST(StepTest, IsThePredictionIntervalOfRegression) {
  const StepTests tests = testSteps({0, 7, 14, 28, 35, 49}, {1.00, 1.02, 0.99, 1.01, 1.00, 1.10}, 0.01);
  ASSERT_EQ(tests.steps.size(), 6u);
  EXPECT_NEAR(tests.steps[5].predicted, 1.001860465116279, 1e-12);
  EXPECT_NEAR(tests.steps[5].half_width, 0.1194499610920537, 1e-10);
  EXPECT_FALSE(tests.steps[5].changed);
  EXPECT_EQ(tests.steps[2].untested, kTooFew);
  EXPECT_EQ(tests.steps[3].untested, "");
}

TEST(StepTest, FindsNothingMoreOftenThanItsLevelWhereNothingChanged) {
  constexpr double kLevel = 0.05;
  for (const double slope : {0.0, 1.0}) {  // wear of seven deviations a date is no sudden change either
    std::vector<int> found(10, 0);
    constexpr int kCourses = 4000;
    for (int seed = 0; seed < kCourses; ++seed) {
      const std::vector<double> y = course(static_cast<std::uint64_t>(seed), 10, slope);
      const StepTests tests = testSteps(days(10), y, kLevel);
      for (std::size_t i = 0; i < 10; ++i) found[i] += tests.steps[i].changed;
    }
    // Four standard errors of a binomial share.
    const double allowed = 4 * std::sqrt(kLevel * (1 - kLevel) / kCourses);
    EXPECT_EQ(found[2], 0);
    EXPECT_NEAR(found[3] / double(kCourses), kLevel, allowed) << "slope " << slope;
    // Less often from then on, because a course that began anew is not tested at once.
    for (std::size_t i = 4; i < found.size(); ++i) {
      EXPECT_LE(found[i] / double(kCourses), kLevel + allowed) << "value " << i << ", slope " << slope;
      EXPECT_GE(found[i] / double(kCourses), kLevel / 2) << "value " << i << ", slope " << slope;
    }
  }
}

TEST(StepTest, FindsAStepWhereItIsAndNotAgain) {
  int at = 0, later = 0;
  constexpr int kCourses = 300;
  for (int seed = 0; seed < kCourses; ++seed) {
    std::vector<double> y = course(static_cast<std::uint64_t>(seed), 12);
    for (std::size_t i = 8; i < y.size(); ++i) y[i] -= 10;
    const StepTests tests = testSteps(days(12), y, 0.01 / 3);
    at += tests.steps[8].changed;
    for (std::size_t i = 9; i < y.size(); ++i) later += tests.steps[i].changed;
  }
  EXPECT_GE(at, 0.9 * kCourses) << "ten deviations";
  EXPECT_LE(later, 0.04 * kCourses) << "the new level is the new course";
}

TEST(StepTest, SaysWhichChangeWouldBeFoundNext) {
  const std::vector<double> y = course(3, 9);
  const double next = testSteps(days(9), y, 0.01, 7).next.half_width;
  for (const double share : {0.9, 1.1}) {
    std::vector<double> more = y;
    more.push_back(0);
    const double predicted = testSteps(days(10), more, 0.01).steps[9].predicted;
    more.back() = predicted + share * next;
    EXPECT_EQ(testSteps(days(10), more, 0.01).steps[9].changed, share > 1);
  }
}

TEST(StepTest, DoesNotJudgeWithoutScatterOrValues) {
  const double nan = std::nan("");
  const StepTests tests = testSteps(days(6), {4, nan, 4, 4, 9, 4}, 0.01);
  EXPECT_EQ(tests.steps[1].untested, kNoValue);
  EXPECT_EQ(tests.steps[3].untested, kTooFew);
  EXPECT_EQ(tests.steps[4].untested, kNoScatter);
  EXPECT_FALSE(tests.steps[4].changed);
  EXPECT_TRUE(std::isnan(testSteps({}, {}, 0.01).next.half_width));
}

}  // namespace
}  // namespace fsr::check
