#include "statistics/error_bins.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace fsr::statistics {
namespace {

TEST(ErrorBins, SeparateBinsAndDirections) {
  ErrorBins bins;
  bins.add(1e3f, 10e3, LoadDirection::kLoading);
  bins.add(-1e3f, 20e3, LoadDirection::kUnloading);
  bins.add(3e3f, 60e3, LoadDirection::kLoading);
  bins.add(7e3f, 500e3, LoadDirection::kNone);
  EXPECT_EQ(bins.count(), 4u);
  const BinnedErrors binned = bins.summarise();
  EXPECT_EQ(binned.whole.all.count, 4u);
  EXPECT_EQ(binned.whole.loading.count, 2u);
  EXPECT_EQ(binned.whole.unloading.bias, -1e3);
  EXPECT_EQ(binned.bins[0].all.bias, 0.0);
  EXPECT_EQ(binned.bins[0].loading.bias, 1e3);
  EXPECT_EQ(binned.bins[1].loading.bias, 3e3);
  EXPECT_EQ(binned.bins[1].unloading.count, 0u);
  EXPECT_EQ(binned.bins[4].all.count, 1u);
}

std::vector<double> normalErrors(std::size_t count) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal(2e3, 5e3);
  std::vector<double> errors(count);
  for (double& error : errors) error = static_cast<float>(normal(random));
  return errors;
}

ErrorTally tallyOf(const std::vector<double>& errors, std::size_t begin, std::size_t end) {
  ErrorTally tally;
  for (std::size_t i = begin; i < end; ++i) tally.add(static_cast<float>(errors[i]));
  return tally;
}

void expectEqual(const ErrorSummary& own, const ErrorSummary& expected, double quantile_tolerance) {
  EXPECT_EQ(own.count, expected.count);
  EXPECT_NEAR(own.bias, expected.bias, 1e-9 * expected.rmse);
  EXPECT_NEAR(own.rmse, expected.rmse, 1e-9 * expected.rmse);
  EXPECT_NEAR(own.limit_low, expected.limit_low, 1e-9 * expected.rmse);
  EXPECT_NEAR(own.limit_high, expected.limit_high, 1e-9 * expected.rmse);
  EXPECT_NEAR(own.p95_absolute, expected.p95_absolute, quantile_tolerance * expected.p95_absolute);
}

TEST(ErrorTally, GivesTheSummaryOfAllErrorsWhileTheyAreKept) {
  const std::vector<double> errors = normalErrors(5000);
  expectEqual(tallyOf(errors, 0, errors.size()).summarise(), summariseErrors(errors), 0);
}

TEST(ErrorTally, CountsManyErrorsInCells) {
  const std::vector<double> errors = normalErrors(3 * ErrorSizes::kKept);
  expectEqual(tallyOf(errors, 0, errors.size()).summarise(), summariseErrors(errors), 1.3e-4);
}

TEST(ErrorTally, MergesKeptAndCountedErrors) {
  const std::vector<double> errors = normalErrors(3 * ErrorSizes::kKept);
  const ErrorSummary expected = summariseErrors(errors);
  for (const std::size_t cut :
       {std::size_t{0}, std::size_t{1}, ErrorSizes::kKept - 1, 2 * ErrorSizes::kKept}) {
    ErrorTally first = tallyOf(errors, 0, cut);
    first.merge(tallyOf(errors, cut, errors.size()));
    expectEqual(first.summarise(), expected, 1.3e-4);
  }
}

TEST(ErrorTally, HasNoLimitsForOneError) {
  ErrorTally tally;
  EXPECT_TRUE(std::isnan(tally.summarise().rmse));
  tally.add(-3.0f);
  EXPECT_EQ(tally.summarise().p95_absolute, 3.0);
  EXPECT_TRUE(std::isnan(tally.summarise().limit_low));
}

}  // namespace
}  // namespace fsr::statistics
