#include "statistics/bootstrap.h"

#include <numeric>

#include "fsr_pressure_map/settings/input_error.h"
#include "statistics/random_stream.h"
#include "statistics/sample_data.h"

namespace {

using namespace sample_data;
using fsr::statistics::bootstrap;
using fsr::statistics::BootstrapProblem;
using fsr::statistics::BootstrapResult;
using fsr::statistics::IntervalMethod;

using Indices = std::vector<std::size_t>;

double meanAt(const Values& x, const Indices& at) {
  double sum = 0;
  for (const std::size_t i : at) sum += x[i];
  return sum / static_cast<double>(at.size());
}

double variationAt(const Values& x, const Indices& at) {
  const double mean = meanAt(x, at);
  double square = 0;
  for (const std::size_t i : at) square += (x[i] - mean) * (x[i] - mean);
  return std::sqrt(square / static_cast<double>(at.size() - 1)) / mean;
}

/// Observation i belongs to unit i / each.
Indices blocks(std::size_t observations, std::size_t each) {
  Indices unit(observations);
  for (std::size_t i = 0; i < observations; ++i) unit[i] = i / each;
  return unit;
}

BootstrapProblem meanOfUnits(const Values& x, std::size_t each = 1) {
  return {{{"cycle", blocks(x.size(), each)}}, [x](const Indices& at) { return meanAt(x, at); }};
}

// library(boot); L <- function(j) mean(j) - j
// boot:::bca.ci(NULL, 0.95, t0 = 0.4, t = pm(31, 199), L = L(c(1,2,4,8,16,17,18,3,5,9)))[4:5]
// boot:::bca.ci(NULL, 0.90, t0 = 0.9, t = -log(pm(32, 999)), L = L(-log(pm(33, 12))))[4:5]
TEST(Bootstrap, BcaIntervalAgreesWithRGivenTheReplicates) {
  const fsr::statistics::Interval one =
      fsr::statistics::bcaInterval(0.4, uniform(31, 199), {1, 2, 4, 8, 16, 17, 18, 3, 5, 9}, 0.95);
  expectNear(one.low, 0.000975154420368836);
  expectNear(one.high, 0.895317718274641);
  const fsr::statistics::Interval other =
      fsr::statistics::bcaInterval(0.9, exponential(32, 999), exponential(33, 12), 0.90);
  expectNear(other.low, 0.0744696075194973);
  expectNear(other.high, 3.04935962091628);
}

TEST(Bootstrap, BcaCountsAReplicateThatEqualsTheEstimateHalf) {
  Values replicates;  // a discrete statistic: 0, 1 and 2, below the estimate as often as above
  for (const auto& [value, times] : {std::pair{0.0, 25}, {1.0, 50}, {2.0, 25}})
    replicates.insert(replicates.end(), times, value);
  const fsr::statistics::Interval interval = fsr::statistics::bcaInterval(1, replicates, {1, 2, 3}, 0.95);
  EXPECT_EQ(interval.low, 0);
  EXPECT_EQ(interval.high, 2);
}

TEST(Bootstrap, BcaEndsAtTheExtremeReplicatesWhereTheyAreTooFew) {
  const fsr::statistics::Interval interval =
      fsr::statistics::bcaInterval(3.5, {1, 2, 3, 4, 5, 6}, {1, 2, 3}, 0.95);
  EXPECT_EQ(interval.low, 1);
  EXPECT_EQ(interval.high, 6);
  const fsr::statistics::Interval beyond =
      fsr::statistics::bcaInterval(9, {1, 2, 3, 4, 5, 6}, {1, 2, 3}, 0.95);
  EXPECT_LE(beyond.low, beyond.high);
  EXPECT_EQ(beyond.high, 6);
}

// set.seed(1); b <- boot(x70, function(d, i) sd(d[i]) / mean(d[i]), 40000)
// j <- sapply(1:70, function(i) sd(x70[-i]) / mean(x70[-i]))
// c(b$t0, boot:::bca.ci(NULL, 0.95, t0 = b$t0, t = b$t[, 1], L = mean(j) - j)[4:5], sd(b$t[, 1]))
TEST(Bootstrap, AgreesWithRWithinTheScatterOfResampling) {
  fsr::statistics::BootstrapOptions options;
  options.resamples = 40000;
  const BootstrapProblem problem{{{"taxel", blocks(70, 1)}},
                                 [](const Indices& at) { return variationAt(kX70, at); }};
  const BootstrapResult result = bootstrap(problem, options);
  expectNear(result.estimate, 1.40464086498423);
  EXPECT_NEAR(result.low, 1.1341941293642, 0.02);
  EXPECT_NEAR(result.high, 1.85444722302068, 0.02);
  EXPECT_NEAR(result.standard_error, 0.171601729709378, 0.003);
  EXPECT_EQ(result.method, IntervalMethod::kBca);
  EXPECT_EQ(result.resamples, 40000u);
}

// y <- x70[1:7]; r <- t.test(y); sprintf("%.15g", c(r$estimate, r$conf.int, sd(y) / sqrt(7)))
TEST(Bootstrap, IsStudentsIntervalForAMeanOfFewUnits) {
  const BootstrapResult result = bootstrap(meanOfUnits(head(kX70, 7)));
  expectNear(result.estimate, 2.30475653150291);
  expectNear(result.low, -0.698978002231156);
  expectNear(result.high, 5.30849106523697);
  expectNear(result.standard_error, 1.22756139839224);
  EXPECT_EQ(result.method, IntervalMethod::kT);
}

TEST(Bootstrap, ResamplesTheHighestLevelWithFiveUnits) {
  BootstrapProblem problem = meanOfUnits(kX70);
  problem.levels = {{"sheet", Indices(70, 0)},
                    {"mount", blocks(70, 20)},
                    {"cycle", blocks(70, 10)},
                    {"taxel", blocks(70, 1)}};
  const BootstrapResult result = bootstrap(problem);
  EXPECT_EQ(result.level, "cycle");
  EXPECT_EQ(result.units, 7u);
  EXPECT_EQ(result.method, IntervalMethod::kT);
}

TEST(Bootstrap, GivesAnIntervalForFiveUnits) {
  BootstrapProblem problem = meanOfUnits(kX70);
  problem.levels = {{"mount", blocks(70, 14)}, {"taxel", blocks(70, 1)}};
  EXPECT_EQ(bootstrap(problem).level, "mount");
  EXPECT_EQ(bootstrap(problem).method, IntervalMethod::kT);
}

TEST(Bootstrap, GivesNoIntervalWithoutFiveUnitsAnywhere) {
  BootstrapProblem problem = meanOfUnits(kX70);
  problem.levels = {{"mount", Indices(70, 3)}, {"cycle", blocks(70, 20)}};
  const BootstrapResult result = bootstrap(problem);
  EXPECT_EQ(result.method, IntervalMethod::kNone);
  EXPECT_EQ(result.level, "cycle");
  EXPECT_EQ(result.units, 4u);
  EXPECT_TRUE(std::isfinite(result.estimate));
  EXPECT_TRUE(std::isnan(result.low));
}

TEST(Bootstrap, ChangesMethodAtTenUnits) {
  EXPECT_EQ(bootstrap(meanOfUnits(head(kX70, 9))).method, IntervalMethod::kT);
  EXPECT_EQ(bootstrap(meanOfUnits(head(kX70, 10))).method, IntervalMethod::kBca);
}

TEST(Bootstrap, DrawsWholeUnits) {
  BootstrapProblem problem = meanOfUnits(kX70, 5);
  problem.statistic = [](const Indices& at) {
    for (std::size_t i = 0; i < at.size(); ++i) {
      if (at[i] / 5 != at[i - i % 5] / 5) return std::nan("");
    }
    return static_cast<double>(at.size());
  };
  const BootstrapResult result = bootstrap(problem);
  EXPECT_EQ(result.resamples, 1999u);
  EXPECT_EQ(result.low, 70);  // a constant statistic
  EXPECT_EQ(result.high, 70);
}

TEST(Bootstrap, GivesTheSameNumbersOnAnyNumberOfThreads) {
  fsr::statistics::BootstrapOptions options;
  const BootstrapResult one = bootstrap(meanOfUnits(kX70), options);
  for (const std::size_t threads : {2, 3, 8}) {
    options.threads = threads;
    const BootstrapResult many = bootstrap(meanOfUnits(kX70), options);
    EXPECT_EQ(many.low, one.low);
    EXPECT_EQ(many.high, one.high);
    EXPECT_EQ(many.standard_error, one.standard_error);
  }
}

TEST(Bootstrap, DependsOnSeedAndStream) {
  fsr::statistics::BootstrapOptions options;
  const double low = bootstrap(meanOfUnits(kX70), options).low;
  options.seed = 2;
  const double of_seed = bootstrap(meanOfUnits(kX70), options).low;
  options.seed = 1;
  options.stream = "other";
  EXPECT_NE(of_seed, low);
  EXPECT_NE(bootstrap(meanOfUnits(kX70), options).low, low);
}

TEST(Bootstrap, IgnoresResamplesWhoseStatisticIsNotFinite) {
  BootstrapProblem problem = meanOfUnits(kX70);
  problem.statistic = [](const Indices& at) {
    const bool has_first = std::count(at.begin(), at.end(), 0u) > 1;  // in a quarter of the resamples
    return has_first ? std::nan("") : meanAt(kX70, at);
  };
  const BootstrapResult result = bootstrap(problem);
  EXPECT_EQ(result.method, IntervalMethod::kBca);
  EXPECT_LT(result.resamples, 1800u);
  EXPECT_GT(result.resamples, 1000u);
}

TEST(Bootstrap, GivesNoIntervalWhereTheStatisticDependsOnOneUnit) {
  BootstrapProblem problem = meanOfUnits(kX70);
  problem.statistic = [](const Indices& at) {
    return std::count(at.begin(), at.end(), 0u) ? meanAt(kX70, at) : std::nan("");
  };
  EXPECT_EQ(bootstrap(problem).method, IntervalMethod::kNone);
}

TEST(Bootstrap, RethrowsAnExceptionOfTheStatisticInAThread) {
  BootstrapProblem problem = meanOfUnits(kX70);
  problem.statistic = [](const Indices& at) -> double {
    if (std::count(at.begin(), at.end(), 0u) > 3) throw std::runtime_error("no");
    return meanAt(kX70, at);
  };
  fsr::statistics::BootstrapOptions options;
  options.threads = 4;
  EXPECT_THROW(bootstrap(problem, options), std::runtime_error);
}

TEST(Bootstrap, RefusesUnusableProblems) {
  BootstrapProblem problem = meanOfUnits(kX70);
  problem.levels.clear();
  EXPECT_THROW(bootstrap(problem), fsr::settings::InputError);
  problem.levels = {{"cycle", blocks(70, 1)}, {"taxel", blocks(60, 1)}};
  EXPECT_THROW(bootstrap(problem), fsr::settings::InputError);
  problem.levels = {{"cycle", {}}};
  EXPECT_THROW(bootstrap(problem), fsr::settings::InputError);
  problem = meanOfUnits({1, 2, std::nan(""), 4, 5});
  EXPECT_THROW(bootstrap(problem), fsr::settings::InputError);
  fsr::statistics::BootstrapOptions options;
  options.confidence = 1;
  EXPECT_THROW(bootstrap(meanOfUnits(kX70), options), fsr::settings::InputError);
  options = {};
  options.resamples = 0;
  EXPECT_THROW(bootstrap(meanOfUnits(kX70), options), fsr::settings::InputError);
}

}  // namespace
