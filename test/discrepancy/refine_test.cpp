// Tests the fit of effects through the forward model, and where the effects act.

#include "discrepancy/decide/refine.h"

#include <gtest/gtest.h>

#include <cmath>

#include "discrepancy/planted.h"
#include "discrepancy/prove/gap.h"

namespace fsr::discrepancy {
namespace {

// Division by a gain reduces any residual, including noise. The gain of an old sheet hardly changes any more.
TEST(Refine, AGainDoesNotExplainNoiseByDividingIt) {
  const DiscrepancyProblem problem = planted::problem(planted::kTwoSpeeds, "");
  const Measured measured = admit(problem);
  const CommonTraces common = commonTraces(measured);
  const StaticFit fit(measured, CurvePer::kClass, common.all);
  const simulation::EnabledEffect withoutGainWeights{"wear",
                                                     {{"loss", -0.3},
                                                      {"exponent", 0.26},
                                                      {"age", 1e6},
                                                      {"span", 620e3},
                                                      {"fading", INFINITY},
                                                      {"impulse_share", 0},
                                                      {"cycle_duration", 73}}};
  EXPECT_LT(refine(measured, common, fit, problem.simulation, {withoutGainWeights}, {}).share, 0.05);
}

TEST(Refine, KnowsWhereTheSizeOfAnEffectMayBeNone) {
  Refined refined;
  EXPECT_FALSE(mayBeNone(refined)) << "nothing was fitted";
  refined.effects = {{"drift", {}}};
  refined.parameters = {
      {{"zero_per_hour", 40, "counts/h", {-5, 85}}, {"time_constant", 600, "s", {300, 900}}}};
  EXPECT_TRUE(mayBeNone(refined));
  refined.parameters[0].push_back({"rate_per_hour", 0.04, "1/h", {0.01, 0.07}});
  EXPECT_FALSE(mayBeNone(refined));
}

// Where the trace does not change, its amplitude is arbitrary.
TEST(Mask, HeedsAmplitudesAsFarAsTheyAreKnown) {
  const DiscrepancyProblem problem = planted::problem(planted::kTwoSpeeds, "");
  const Measured measured = admit(problem);
  const auto taxels = static_cast<Eigen::Index>(measured.taxels());
  Spread spread;
  spread.amplitude = Eigen::MatrixXd::Constant(taxels, 3, 1.0);
  spread.error = Eigen::MatrixXd::Constant(taxels, 3, 0.01);
  spread.amplitude.col(1).setConstant(5000);
  spread.error.col(1).setConstant(4000);
  const Eigen::MatrixXd mask = maskOf(measured, WhereItShows(), spread);
  EXPECT_NEAR(mask.maxCoeff(), 1, 1e-3);
  EXPECT_NEAR(mask.minCoeff(), 1, 1e-3);
}

}  // namespace
}  // namespace fsr::discrepancy
