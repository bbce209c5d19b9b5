// The tests of the residuals against covariates find nothing in noise and find each planted covariate.
#include "discrepancy/decide/covariate_tests.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "discrepancy/planted.h"
#include "statistics/random_stream.h"

namespace fsr::discrepancy {
namespace {

constexpr int kNights = 40;

std::vector<CovariateTest> testsOf(const DiscrepancyProblem& problem, std::uint64_t draws) {
  const Measured measured = admit(problem);
  const CommonTraces common = commonTraces(measured);
  const StaticFit fit(measured, CurvePer::kClass, common.all);
  const TaxelFit taxels(measured, fit);
  const Candidates candidates(measured, common, fit, {}, 1);
  return CovariateTests{measured, common, fit, taxels, candidates, 1, draws}.run();
}

std::vector<CovariateTest> planted(const std::string& rig, const std::string& more) {
  return testsOf(planted::problem(rig, more), 9999);
}

CovariateTest of(const std::vector<CovariateTest>& tests, const std::string& covariate) {
  const auto found = std::find_if(tests.begin(), tests.end(),
                                  [&](const CovariateTest& t) { return t.covariate == covariate; });
  if (found == tests.end()) ADD_FAILURE() << covariate << " was not tested";
  return found == tests.end() ? CovariateTest() : *found;
}

// Replaces the counts by curves that splines represent exactly, as functions of the pressure after admission.
// The gain scatters from cycle to cycle, and every reading has noise.
void makeNoise(DiscrepancyProblem& problem, std::uint64_t night) {
  const Measured measured = admit(problem);
  const statistics::RandomStream noise = statistics::randomStream(night, "night"),
                                 gains = statistics::randomStream(night, "gain");
  for (std::size_t m = 0; m < measured.samples(); ++m) {
    ASSERT_EQ(measured.scans[m], 1u);
    const double share = measured.pressure[m] / 620e3;
    const double gain = 1 + 0.004 * gains.normal(measured.cycle[m]);
    dataset::Recording& recording = problem.recordings[measured.visits[measured.visit[m]].recording];
    for (std::size_t t = 0; t < measured.taxels(); ++t) {
      const double reading =
          300 + gain * (2600 * share - 700 * share * share + 20.0 * static_cast<double>(t));
      const double count = reading + 8 * noise.normal(m * measured.taxels() + t);
      recording.counts[measured.first_scan[m] * measured.taxels() + t] =
          static_cast<std::uint16_t>(std::lround(count));
    }
  }
}

TEST(CovariateTests, AreUniformOnNoise) {
  std::map<std::string, std::vector<double>> p;
  DiscrepancyProblem problem = planted::problem(planted::kTwoSpeeds, "");
  for (int night = 0; night < kNights; ++night) {
    makeNoise(problem, static_cast<std::uint64_t>(night));
    for (const CovariateTest& test : testsOf(problem, 199)) {
      p[test.covariate].push_back(test.p);
      EXPECT_FALSE(test.depends) << test.covariate << " in night " << night;
    }
  }
  EXPECT_GE(p.size(), 11u);
  for (auto& [covariate, values] : p) {
    std::sort(values.begin(), values.end());
    double apart = 0;  // Kolmogorov-Smirnov distance from the uniform distribution
    for (std::size_t i = 0; i < values.size(); ++i)
      apart = std::max(apart, std::abs(values[i] - (static_cast<double>(i) + 0.5) / kNights));
    // scipy.stats.kstwo.ppf(0.999, 40) = 0.3017: exceeded by chance once in a thousand, for each of eleven
    // tests
    EXPECT_LT(apart, 0.3017) << covariate;
  }
}

TEST(CovariateTests, FindWhatAnEffectDependsOn) {
  EXPECT_TRUE(
      of(planted(planted::kTwoSpeeds, "  hysteresis: {loop_width: 0.05}\n"), "direction x pressure").depends);
  EXPECT_TRUE(of(planted(planted::kTwoSpeeds, "  time_skew: {delay: 0.3}\n"), "pressure_rate").depends);
  const auto leak = planted(planted::kTwoSpeeds, "  seal_leak: {time_constant: 600}\n");
  EXPECT_TRUE(of(leak, "previous_extremes").depends || of(leak, "time_since_reversal").depends);
  EXPECT_TRUE(of(planted(planted::kOneSurface, "  break_in: {change: -0.06}\n"), "cycle").depends);
  EXPECT_TRUE(of(planted(planted::kOneSurface, "  drift: {rate_per_hour: 0.2}\n"), "clock_time").depends);
}

TEST(CovariateTests, FindTheTaxelsThatDeviate) {
  DiscrepancyProblem problem = planted::problem(planted::kTwoSpeeds, "");
  const auto loop = planted::problem(planted::kTwoSpeeds, "  hysteresis: {loop_width: 0.06}\n").recordings;
  for (std::size_t r = 0; r < loop.size(); ++r) {
    for (std::size_t k = 0; k < loop[r].counts.size(); ++k) {
      if (k % 12 / 4 == 1) problem.recordings[r].counts[k] = loop[r].counts[k];  // row 1
    }
  }
  const auto tests = testsOf(problem, 9999);
  EXPECT_TRUE(of(tests, "row").depends);
  EXPECT_TRUE(of(tests, "taxel").depends);
  EXPECT_FALSE(of(tests, "column").depends);
}

TEST(CovariateTests, FewCyclesChangeNoSigns) {
  std::string few = planted::kOneSurface;
  few.replace(few.find("cycles: 16"), 10, "cycles: 6");
  const auto tests = planted(few, "  hysteresis: {loop_width: 0.05}\n");
  const CovariateTest direction = of(tests, "direction x pressure");
  EXPECT_EQ(direction.method, "block_bootstrap");
  EXPECT_TRUE(direction.depends);
  EXPECT_FALSE(of(planted(few, ""), "direction x pressure").depends);
}

}  // namespace
}  // namespace fsr::discrepancy
