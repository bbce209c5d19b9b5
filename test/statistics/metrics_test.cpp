#include "fsr_pressure_map/statistics/metrics.h"

#include <gtest/gtest.h>

#include <cmath>

namespace fsr::statistics {
namespace {

// Expected values: /usr/bin/python3 with numpy 1.24.2 and scipy 1.10.1, where
//   r = np.array([0., 25e3, 75e3, 150e3, 300e3, 620e3])
//   p = np.array([1e3, 24e3, 78e3, 141e3, 310e3, 601e3]); e = p - r
const std::vector<double> kReference = {0, 25e3, 75e3, 150e3, 300e3, 620e3};
const std::vector<double> kPredicted = {1e3, 24e3, 78e3, 141e3, 310e3, 601e3};
const std::vector<double> kErrors = {1e3, -1e3, 3e3, -9e3, 10e3, -19e3};
constexpr double kRounding = 1e-14;  // relative: a few rounding errors of a double

TEST(Metrics, RSquaredAndRmsePercentAgreeWithNumpy) {
  // 1 - ((p-r)**2).sum() / ((r-r.mean())**2).sum()
  EXPECT_NEAR(rSquared(kPredicted, kReference), 0.9979890909090909, kRounding);
  // 100 * np.sqrt(((p-r)**2).mean()) / np.ptp(r)
  EXPECT_NEAR(rmsePercent(kPredicted, kReference), 1.5484430993456635, 1.5 * kRounding);
}

TEST(Metrics, RSquaredIsNegativeWhereTheMeanPredictsBetter) {
  EXPECT_LT(rSquared({3, 2, 1}, {1, 2, 3}), 0);
}

TEST(Metrics, ScoresAreNanWhereTheReferenceDoesNotVary) {
  EXPECT_TRUE(std::isnan(rSquared({1, 2}, {5, 5})));
  EXPECT_TRUE(std::isnan(rSquared({1}, {5})));
  EXPECT_TRUE(std::isnan(rmsePercent({1, 2}, {5, 5})));
  EXPECT_TRUE(std::isnan(rmsePercent({}, {})));
}

TEST(Metrics, ErrorSummaryAgreesWithScipy) {
  const ErrorSummary summary = summariseErrors(kErrors);
  EXPECT_EQ(summary.count, 6u);
  EXPECT_NEAR(summary.bias, -2500.0, 2500 * kRounding);
  EXPECT_NEAR(summary.rmse, 9600.347215943113, 1e4 * kRounding);  // np.sqrt((e**2).mean())
  // e.mean() -+ stats.norm.ppf(.975) * e.std(ddof=1)
  EXPECT_NEAR(summary.limit_low, -22401.115657509363, 3e4 * kRounding);
  EXPECT_NEAR(summary.limit_high, 17401.115657509363, 3e4 * kRounding);
  EXPECT_NEAR(summary.p95_absolute, 16750.0, 2e4 * kRounding);  // np.percentile(abs(e), 95)
}

TEST(Metrics, ErrorSummaryOfOneErrorHasNoLimits) {
  const ErrorSummary summary = summariseErrors({-3.0});
  EXPECT_EQ(summary.bias, -3.0);
  EXPECT_EQ(summary.rmse, 3.0);
  EXPECT_EQ(summary.p95_absolute, 3.0);
  EXPECT_TRUE(std::isnan(summary.limit_low));
}

TEST(Metrics, ErrorSummaryOfNoErrorsIsNan) {
  const ErrorSummary summary = summariseErrors({});
  EXPECT_EQ(summary.count, 0u);
  EXPECT_TRUE(std::isnan(summary.bias));
  EXPECT_TRUE(std::isnan(summary.rmse));
  EXPECT_TRUE(std::isnan(summary.p95_absolute));
}

TEST(Metrics, QuantileInterpolatesBetweenOrderStatistics) {
  std::vector<double> values = {5, 1, 4, 2, 3, 9};
  EXPECT_DOUBLE_EQ(quantile(values, 0.3), 2.5);  // np.quantile(values, 0.3)
  EXPECT_DOUBLE_EQ(quantile(values, 0.0), 1.0);
  EXPECT_DOUBLE_EQ(quantile(values, 1.0), 9.0);
  std::vector<double> nothing;
  EXPECT_TRUE(std::isnan(quantile(nothing, 0.5)));
}

TEST(Metrics, SpreadIgnoresNan) {
  const Spread spread = spreadOf({1.0, std::nan(""), 3.0});
  EXPECT_DOUBLE_EQ(spread.mean, 2.0);
  EXPECT_DOUBLE_EQ(spread.deviation, std::sqrt(2.0));
  EXPECT_TRUE(std::isnan(spreadOf({std::nan("")}).mean));
  EXPECT_TRUE(std::isnan(spreadOf({1.0}).deviation));
}

TEST(PressureBins, IncludeTheirLowerEdgeAndNotTheirUpper) {
  EXPECT_EQ(pressureBin(-2e3), 0u);
  EXPECT_EQ(pressureBin(49999.0), 0u);
  EXPECT_EQ(pressureBin(50e3), 1u);
  EXPECT_EQ(pressureBin(399999.0), 3u);
  EXPECT_EQ(pressureBin(400e3), 4u);
  EXPECT_EQ(pressureBin(1e7), 4u);
}

TEST(PressureBins, AreNamedInKilopascal) {
  EXPECT_EQ(pressureBinName(0), "0-50");
  EXPECT_EQ(pressureBinName(3), "200-400");
  EXPECT_EQ(pressureBinName(4), "400+");
}

}  // namespace
}  // namespace fsr::statistics
