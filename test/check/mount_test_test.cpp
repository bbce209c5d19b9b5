#include "check/correction.h"

#include <gtest/gtest.h>

#include <cmath>

#include "statistics/random_stream.h"

namespace {

using fsr::check::CommonChange;
using fsr::check::MountChange;
using fsr::check::MountScatter;
using fsr::check::testCommonChange;

// R: t.test(c(3, 4, 5)) scaled by sqrt((1/3) / (1/3 + 1)): t = 4 / (1 * sqrt(4/3)), 2 degrees of freedom.
TEST(CommonChange, IsStudentsTestWithTheMountsOfTheTrainingInTheError) {
  const std::vector<MountChange> mounts = {{0, {3}}, {0, {4}}, {0, {5}}};
  const CommonChange change = testCommonChange(mounts, {1}, {});
  EXPECT_NEAR(change.size, 4, 1e-12);
  EXPECT_NEAR(change.scatter.deviation, 1, 1e-12);
  EXPECT_EQ(change.scatter.freedom, 2u);
  const double t = 4 / std::sqrt(4.0 / 3);
  EXPECT_NEAR(change.p, 1 - t / std::sqrt(2 + t * t), 1e-12);  // of two degrees of freedom
  EXPECT_LT(testCommonChange(mounts, {9}, {}).p, change.p);
}

TEST(CommonChange, OfOneMountNeedsTheScatterOfTheTraining) {
  const CommonChange unknown = testCommonChange({{0, {30e3, 0}}}, {1}, {});
  EXPECT_FALSE(unknown.scatter.known());
  EXPECT_EQ(unknown.p, 1);
  const CommonChange known = testCommonChange({{0, {30e3, 0}}}, {1}, MountScatter{3e3, 6});
  EXPECT_EQ(known.scatter.freedom, 6u);
  EXPECT_LT(known.p, 0.001);
}

TEST(CommonChange, TakesTheScatterWithMoreDegreesOfFreedom) {
  const std::vector<MountChange> mounts = {{0, {3}}, {0, {4}}, {0, {5}}};
  EXPECT_NEAR(testCommonChange(mounts, {1}, MountScatter{7, 2}).scatter.deviation, 7, 1e-12);
  EXPECT_NEAR(testCommonChange(mounts, {1}, MountScatter{7, 1}).scatter.deviation, 1, 1e-12);
}

// Share of sheets without any change that are taken for changed at 5 %. Each mount scatters with
// `deviations`, and so do those of the training.
double falseAlarms(const std::vector<double>& deviations, const std::vector<std::size_t>& rechecked,
                   const std::vector<std::size_t>& trained) {
  constexpr std::size_t kSheets = 4000;
  std::size_t alarms = 0;
  for (std::size_t sheet = 0; sheet < kSheets; ++sheet) {
    const auto stream = fsr::statistics::randomStream(1, "mount_test_test", sheet);
    std::uint64_t next = 0;
    std::vector<MountChange> mounts;
    for (std::size_t s = 0; s < rechecked.size(); ++s) {
      std::vector<double> training(deviations.size(), 0.0);
      for (std::size_t i = 0; i < deviations.size(); ++i)
        training[i] = deviations[i] * stream.normal(next++) / std::sqrt(double(trained[s]));
      for (std::size_t j = 0; j < rechecked[s]; ++j) {
        MountChange mount{s, training};
        for (std::size_t i = 0; i < deviations.size(); ++i)
          mount.change[i] += deviations[i] * stream.normal(next++);
        mounts.push_back(mount);
      }
    }
    alarms += testCommonChange(mounts, trained, {}).p < 0.05;
  }
  return double(alarms) / double(kSheets);
}

// 0.06: 5 % and three standard errors of 4,000 sheets.
TEST(CommonChange, TakesAtMostFivePercentOfUnchangedSheetsForChanged) {
  EXPECT_NEAR(falseAlarms({1}, {2}, {1}), 0.05, 0.0104);
  EXPECT_NEAR(falseAlarms({1}, {3}, {1}), 0.05, 0.0104);
  EXPECT_NEAR(falseAlarms({1}, {2, 1, 1}, {1, 1, 3}), 0.05, 0.0104);
  EXPECT_LT(falseAlarms({1, 0.5}, {3}, {1}), 0.06);
  EXPECT_LT(falseAlarms({1, 1}, {2}, {1}), 0.06);
  EXPECT_LT(falseAlarms({1, 1, 1, 1, 1, 1, 1, 1}, {3}, {1}), 0.06);
}

}  // namespace
