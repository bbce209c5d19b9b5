// Tests which experiment is recommended.

#include "discrepancy/prove/next_experiment.h"

#include <gtest/gtest.h>

#include "discrepancy/planted.h"
#include "simulation/effects/effect_library.h"
#include "simulation/pressure_profile.h"

namespace fsr::discrepancy {
namespace {

simulation::SimulationSettings rig() {
  return planted::simulation(planted::kFourTaxels + planted::kTwoSurfaces);
}

simulation::EnabledEffect usual(const std::string& id) {
  simulation::EnabledEffect enabled{id, {}};
  for (const simulation::EffectParameter& parameter : simulation::findEffect(id)->info.parameters)
    enabled.values[parameter.name] = parameter.usual;
  return enabled;
}

// Noise of the order of the planted rigs: a scan's of 1e-3, a gain that scatters by 0.5 % between cycles.
Contest contest(const std::vector<std::string>& ids) {
  Contest contest;
  for (const std::string& id : ids) contest.explanations.push_back({usual(id)});
  contest.weights.assign(ids.size(), 1 / static_cast<double>(ids.size()));
  contest.unknown = 0.05;
  contest.noise = {{{1, 1e4, 0, 1e-8, 1e-8, 1e-8, 2.5e-5, 1e-8}}, 75, 1e-6};
  return contest;
}

TEST(NextExperiment, TakesHoursWhereWearIsAmongTheExplanations) {
  Contest slow = contest({"wear", "drift", "break_in"});
  slow.explanations[0][0].values["loss"] = 0.3;
  const auto next = nextExperiment(rig(), slow);
  ASSERT_EQ(next.size(), 1u);
  EXPECT_EQ(next[0].protocol, "hours_apart");
  EXPECT_NE(next[0].sentence.find("8 hours"), std::string::npos) << next[0].sentence;
  EXPECT_GT(next[0].separation, 0);
}

TEST(NextExperiment, TakesTwoPacesWhereALoopMayBeAShortMemory) {
  const auto next = nextExperiment(rig(), contest({"hysteresis", "creep"}));
  ASSERT_EQ(next.size(), 1u);
  const std::vector<std::string> two_paces = {"two_speeds", "step_hold", "random_order"};
  EXPECT_EQ(std::count(two_paces.begin(), two_paces.end(), next[0].protocol), 1) << next[0].protocol;
  EXPECT_GE(next[0].certainty, 0.95);
  EXPECT_LT(next[0].entropy, next[0].entropy_before);
  EXPECT_GE(next[0].cycles, 10);
  EXPECT_NE(next[0].sentence.find("hysteresis and creep"), std::string::npos) << next[0].sentence;
}

TEST(NextExperiment, NeedsMoreCyclesWhereTheNoiseIsLarger) {
  Contest quiet = contest({"hysteresis", "creep"}), loud = quiet;
  quiet.at_hand.two_rates = loud.at_hand.two_rates = true;
  loud.noise.noise.variance[CycleNoise::kSlow] = 3e-3;
  const auto few = nextExperiment(rig(), quiet), many = nextExperiment(rig(), loud);
  ASSERT_FALSE(few.empty());
  ASSERT_FALSE(many.empty());
  EXPECT_LT(many[0].separation / std::sqrt(many[0].cycles), few[0].separation / std::sqrt(few[0].cycles));
  EXPECT_TRUE(many[0].cycles > few[0].cycles || many[0].certainty < few[0].certainty) << many[0].sentence;
}

TEST(NextExperiment, TakesASecondRoundWhereNoProtocolBringsAllEvidence) {
  Contest both = contest({"hysteresis", "wear"});
  both.explanations[1][0].values["loss"] = 0.3;
  const auto next = nextExperiment(rig(), both);
  ASSERT_EQ(next.size(), 2u);
  EXPECT_EQ(next[0].protocol == "hours_apart" || next[1].protocol == "hours_apart", true);
  EXPECT_EQ(next[1].sentence.find("Then record"), 0u) << next[1].sentence;
}

TEST(NextExperiment, IsNoneForOneExplanation) {
  EXPECT_TRUE(nextExperiment(rig(), contest({"wear"})).empty());
}

TEST(NextExperiment, IsForAllThatAreNotExcludedWhateverTheirWeights) {
  Contest sure = contest({"hysteresis", "creep"});
  sure.at_hand.two_rates = true;
  sure.weights = {1 - 1e-12, 1e-12};
  sure.unknown = 1e-12;
  EXPECT_EQ(nextExperiment(rig(), sure).size(), 1u);
}

TEST(NextExperiment, FitsAChamberOf200kPa) {
  for (const std::string& name : protocolNames()) {
    const simulation::SimulationSettings small = runProtocol(name, rig(), 200e3);
    double highest = 0;
    for (const simulation::Station& station : small.session) {
      const simulation::PressureProfile profile = simulation::pressureProfile(station.program);
      for (double time = 0; time < profile.duration(); time += 0.25)
        highest = std::max(highest, profile.at(time));
    }
    EXPECT_LE(highest, 200e3 * (1 + 1e-9)) << name;
    EXPECT_GT(highest, 170e3) << name;
  }
  Contest small = contest({"hysteresis", "creep"});
  small.peak = 200e3;
  for (const auto& next : {nextExperiment(rig(), small), experimentFor({"pressure_rate"}, true, 200e3)}) {
    ASSERT_FALSE(next.empty());
    EXPECT_NE(next[0].sentence.find("up to 200 kPa"), std::string::npos) << next[0].sentence;
    EXPECT_EQ(next[0].sentence.find("40 kPa/s"), std::string::npos) << next[0].sentence;
  }
  EXPECT_NE(experimentFor({"pressure_rate"}, true, 200e3)[0].sentence.find("at 2.6 and at 13 kPa/s"),
            std::string::npos);
}

TEST(ExpectedKnowledge, IsThatOfThePriorWhereNothingIsSeen) {
  const ExpectedKnowledge before = expectedKnowledge(Eigen::Matrix2d::Zero(), contest({"creep", "drift"}));
  EXPECT_NEAR(before.entropy, -2 * 0.475 * std::log(0.475) - 0.05 * std::log(0.05), 1e-9);
  EXPECT_NEAR(before.certainty, 2 * 0.475 * 0.475 + 0.05 * 0.05, 1e-9);
}

TEST(ExpectedKnowledge, GrowsWithTheDistanceOfTheExplanations) {
  const Contest two = contest({"creep", "drift"});
  Eigen::Matrix2d same;
  same << 1, 1, 1, 1;
  const ExpectedKnowledge alike = expectedKnowledge(1e4 * same, two);
  EXPECT_LT(alike.certainty, 0.55);
  double last = alike.entropy;
  for (const double distance : {1.0, 10.0, 100.0, 1e4}) {
    const ExpectedKnowledge apart = expectedKnowledge(distance * Eigen::Matrix2d::Identity(), two);
    if (distance > 1) {
      EXPECT_LT(apart.entropy, last) << distance;
    }
    last = apart.entropy;
  }
  EXPECT_LT(last, 0.05);
}

}  // namespace
}  // namespace fsr::discrepancy
