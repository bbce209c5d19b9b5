// Freezes a prediction and holds it against new recordings of another protocol.

#include <gtest/gtest.h>

#include "discrepancy/fit/parameter_fit.h"
#include "discrepancy/planted.h"
#include "discrepancy/prove/freeze.h"

namespace fsr::discrepancy {
namespace {

const char* const kLoopText = "  hysteresis: {loop_width: 0.05}\n";
const char* const kMemoryText = "  creep: {per_decade: 0.03, slowest: 100}\n";

// Another protocol and other noise than planted::kTwoSpeeds.
const std::string kNewProtocol = planted::rig(R"(program:
  - cycles: {peak: 500000, rate: 25000, dwell_peak: 20, cycles: 3}
  - hold: {pressure: 300000, rate: 12000, duration: 40}
  - rest: {rate: 12000, duration: 30}
  - cycles: {peak: 600000, rate: 12000, dwell_peak: 2, cycles: 3}
)",
                                              planted::kTwoSurfaces, "{absolute: 8}", 29);

struct Frozen {
  Prediction prediction;
  simulation::SimulationSettings base;
};

simulation::EnabledEffect effect(const std::string& text) {
  const simulation::SimulationSettings with = planted::simulation(planted::kTwoSpeeds, text);
  const simulation::SimulationSettings without = planted::simulation(planted::kTwoSpeeds);
  for (const simulation::EnabledEffect& one : with.effects)
    if (!without.effect(one.id)) return one;
  return {};
}

// A prediction of `named`, with `rival` beside it; both are fitted to the recordings of the problem.
Frozen frozen(const DiscrepancyProblem& problem, const std::string& named, const std::string& rival) {
  const Measured measured = admit(problem);
  const CommonTraces common = commonTraces(measured);
  const StaticFit fit(measured, CurvePer::kClass, common.all);
  Frozen frozen;
  frozen.base = fitBase(measured, fit, problem.simulation);
  Decision decision;
  decision.refined = refine(measured, common, fit, frozen.base, {effect(named)}, {});
  decision.rivals = {refine(measured, common, fit, frozen.base, {effect(rival)}, {})};
  decision.densities = {{0, 0, 0}, {0, 0, 0}};
  frozen.prediction = freeze(decision, measured, common, fit, frozen.base, problem.options);
  frozen.prediction.hash = hashOf(frozen.prediction, frozen.base);
  return frozen;
}

std::vector<dataset::Recording> newRecordings(const std::string& hidden) {
  return simulation::simulateSession(planted::simulation(kNewProtocol, hidden));
}

Confirmation answer(const Frozen& frozen, const std::string& hidden) {
  return confirm(frozen.prediction, frozen.base, newRecordings(hidden));
}

class Confirm : public testing::Test {
 protected:
  static const Frozen& loop() {
    static const Frozen one =
        frozen(planted::problem(planted::kTwoSpeeds, kLoopText), kLoopText, kMemoryText);
    return one;
  }
};

TEST_F(Confirm, PassesForTheRightEffectUnderAnotherProtocol) {
  const Confirmation confirmation = answer(loop(), kLoopText);
  EXPECT_TRUE(confirmation.passed) << confirmation.sentence;
  EXPECT_NEAR(confirmation.size, 1, 0.02);
  EXPECT_LE(confirmation.p, 0.01);
  ASSERT_EQ(confirmation.rivals.size(), 1u);
  EXPECT_EQ(confirmation.rivals[0].explanation, "creep");
  EXPECT_LT(confirmation.rivals[0].nats, 0);
  EXPECT_FALSE(confirmation.rivals[0].better);
  EXPECT_NE(confirmation.sentence.find("was predicted for these bags (95 %)"), std::string::npos);
}

TEST_F(Confirm, FailsForAWrongEffectAndNamesTheRivalThatIsBetter) {
  const Frozen memory = frozen(planted::problem(planted::kTwoSpeeds, kLoopText), kMemoryText, kLoopText);
  const Confirmation confirmation = answer(memory, kLoopText);
  EXPECT_FALSE(confirmation.passed) << confirmation.sentence;
  EXPECT_EQ(confirmation.best_rival, "hysteresis");
  EXPECT_TRUE(confirmation.rivals.at(0).better);
  EXPECT_GT(confirmation.rivals.at(0).nats, 0);
}

TEST_F(Confirm, FailsForThreeTimesTheSize) {
  const Confirmation confirmation = answer(loop(), "  hysteresis: {loop_width: 0.15}\n");
  EXPECT_FALSE(confirmation.passed) << confirmation.sentence;
  EXPECT_TRUE(confirmation.best_rival.empty()) << "only the size is wrong";
  EXPECT_NEAR(confirmation.size, 3, 0.1);
  EXPECT_LT(confirmation.predicted.high, 2);
}

TEST_F(Confirm, FailsWhereNothingIsVisible) {
  const Confirmation confirmation = answer(loop(), "");
  EXPECT_FALSE(confirmation.passed) << confirmation.sentence;
  EXPECT_GT(confirmation.p, 0.01);
}

TEST_F(Confirm, TakesTheIntervalOfAPredictionFromAnEarlierVersion) {
  Frozen old = loop();
  old.prediction.weights.clear();
  old.prediction.spread = {};
  old.prediction.size = {0.6, 1.6};
  old.prediction.hash = hashOf(old.prediction, old.base);
  const Confirmation confirmation = answer(old, kLoopText);
  EXPECT_TRUE(confirmation.passed) << confirmation.sentence;
  EXPECT_NE(confirmation.sentence.find("earlier version"), std::string::npos);
}

TEST_F(Confirm, HasACovarianceOfTheParameters) {
  const auto& covariance = loop().prediction.spread.covariance;
  ASSERT_GE(covariance.size(), 2u);
  for (std::size_t k = 0; k < covariance.size(); ++k) {
    EXPECT_GE(covariance[k][k], 0) << k << ": 0 = at an end of its range";
    for (std::size_t l = 0; l < k; ++l) EXPECT_EQ(covariance[k][l], covariance[l][k]) << k << ", " << l;
  }
}

TEST(Freeze, PredictsAWiderRangeWithFewerCycles) {
  const auto width = [](int cycles) {
    std::string text = planted::kOneSurface;
    text.replace(text.find("cycles: 16"), 10, "cycles: " + std::to_string(cycles));
    const Prediction made = frozen(planted::problem(text, kLoopText), kLoopText, kMemoryText).prediction;
    EXPECT_LT(made.size.low, 1);
    EXPECT_GT(made.size.high, 1);
    return made.size.high - made.size.low;
  };
  EXPECT_GT(width(4), 1.3 * width(16));
}

TEST(Freeze, RangeHoldsTheScatterOfParametersCyclesAndGroups) {
  ParameterSpread spread;
  spread.cycles = 20;
  Predicted here;
  here.variance = 0.0001;
  const auto width = [&] {
    const Interval range = predictiveInterval(here, spread, 20);
    return range.high - range.low;
  };
  const double of_cycles = width();
  EXPECT_NEAR(of_cycles, 2 * 2.093 * 0.01, 1e-4) << "Student's t with 19 degrees of freedom";
  here.of_spread = 0.0003;
  const double with_parameters = width();
  EXPECT_GT(with_parameters, 1.8 * of_cycles);
  spread.between = 0.01;
  spread.groups = 6;
  EXPECT_GT(width(), 2 * with_parameters);
}

// Two visits of four cycles. Within a visit the cycles scatter by 0.01, the visits differ by 0.2.
TEST(Freeze, MeasuresHowMuchTheSizeDiffersBetweenMounts) {
  Measured measured;
  Predicted here;
  for (std::size_t c = 0; c < 8; ++c) {
    MeasuredCycle cycle;
    cycle.visit = c / 4;
    cycle.first = c;
    cycle.last = c + 1;
    measured.cycles.push_back(cycle);
    here.apart.push_back((c < 4 ? -0.1 : 0.1) + (c % 2 ? 0.01 : -0.01));
    here.information.push_back(5);
  }
  measured.time.assign(8, 0);
  measured.pressure.assign(8, 1e5);
  measured.rate.assign(8, 1e3);
  ParameterSpread spread;
  judgeGroups(measured, here, spread);
  EXPECT_EQ(spread.groups, 2u);
  EXPECT_NEAR(spread.between, 0.02, 1e-4) << "variance of -0.1 and 0.1, less that of their means";
}

TEST(Freeze, WeighsExplanationsByThePredictiveDensityOfTheCycles) {
  const std::vector<double> even = weightsOf({{1, 2, 3}, {1, 2, 3}}, 200, 1);
  EXPECT_NEAR(even[0], 0.5, 1e-12);
  const std::vector<double> behind = weightsOf({{5, 6, 5, 6}, {1, 2, 1, 2}}, 200, 1);
  EXPECT_GT(behind[0], 0.99);
  const std::vector<double> uneven = weightsOf({{5, 0, 5, 0}, {0, 5.2, 0, 5.2}}, 999, 1);
  EXPECT_NEAR(uneven[0], 0.5, 0.1) << "which of them is better depends on the cycles drawn";
}

}  // namespace
}  // namespace fsr::discrepancy
