// The effects that were found must hold on surfaces and protocols that their sizes were not fitted to. Their
// errors in use are tested too.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "discrepancy/planted.h"
#include "discrepancy/prove/report_gap.h"
#include "discrepancy/samples/views.h"

namespace fsr::discrepancy {
namespace {

using Names = std::vector<std::string>;

Names namesOf(const std::vector<Part>& parts) {
  Names names;
  for (const Part& part : parts) names.push_back(part.name);
  return names;
}

TEST(HeldOut, PartsAreSurfacesAndSpeedsWhereTheDataHaveThem) {
  const DiscrepancyProblem two = planted::problem(planted::kTwoSpeeds, "");
  const Measured measured = admit(two);
  EXPECT_EQ(namesOf(partsByCondition(measured)), (Names{"flat", "cylinder_9cm", "cylinder_5cm"}));
  const std::vector<Part> speeds = partsByProtocol(measured);
  EXPECT_EQ(namesOf(speeds), (Names{"ramps of 8 kPa/s", "ramps of 40 kPa/s"}));
  EXPECT_EQ(speeds.at(0).cycles.size(), 9u);
  EXPECT_EQ(speeds.at(1).cycles.size(), 24u);
  const DiscrepancyProblem one = planted::problem(planted::kOneSurface, "");
  EXPECT_TRUE(partsByCondition(admit(one)).empty());
  EXPECT_TRUE(partsByProtocol(admit(one)).empty());
}

// On one surface the loop is four times as wide. A fit without this surface predicts a narrow loop.
TEST(HeldOut, SaysSoWhereASurfaceIsNotForetoldByTheOthers) {
  DiscrepancyProblem problem = planted::problem(planted::kTwoSpeeds, "  hysteresis: {loop_width: 0.025}\n");
  problem.recordings.back() =
      planted::problem(planted::kTwoSpeeds, "  hysteresis: {loop_width: 0.1}\n").recordings.back();
  const DiscrepancyReport report = investigate(problem);
  ASSERT_FALSE(report.gap.foretold.empty()) << report.sentence;
  EXPECT_EQ(report.gap.foretold.front().by, "condition");
  // The wide loop is not foretold from the narrow ones. Nor is the narrow one of the other cylinder, where
  // the fit to the rest is drawn to the wide one: both are told.
  const auto told = [](const std::string& said) {
    return said.find("On cylinder_") == 0 && said.find("the explanation is weak") != std::string::npos;
  };
  EXPECT_TRUE(std::any_of(report.limitations.begin(), report.limitations.end(), told)) << report.sentence;
  for (const auto& [name, closed] : report.gap.foretold.front().parts) {
    if (name == "cylinder_5cm") {
      EXPECT_LT(closed, 0.6);
    }
  }
}

TEST(HeldOut, WhatIsMissingIsSaid) {
  const DiscrepancyReport report =
      investigate(planted::problem(planted::kOneSurface, "  time_skew: {delay: 0.5}\n"));
  ASSERT_FALSE(report.effects.empty()) << report.sentence;
  EXPECT_EQ(report.gap.held_out_by, Names{"cycles"});
  EXPECT_EQ(report.gap.missing.size(), 3u);
}

// Bags of 11 cycles on three surfaces: 2, 2 and 2 of them are held out.
TEST(HeldOut, CyclesAreNamedByTheStampsOfTheirScans) {
  const DiscrepancyProblem problem = planted::problem(planted::kTwoSpeeds, "");
  const Measured measured = admit(problem);
  std::size_t held = 0;
  for (const MeasuredCycle& cycle : measured.cycles) held += cycle.use == CycleUse::kHoldOut;
  EXPECT_EQ(held, 6u);
  std::size_t spans = 0;
  for (const HoldOutCycles& bag : HoldOutView(measured, FitView(measured)).spans())
    spans += bag.cycles.size();
  EXPECT_EQ(spans, 6u);
}

double costOf(const std::vector<GapInUse>& costs, const std::string& situation) {
  for (const GapInUse& cost : costs) {
    if (cost.situation == situation) return cost.before;
  }
  return NAN;
}

TEST(CostsInUse, OfALateClockAreSpeedTimesDelay) {
  const DiscrepancyProblem problem = planted::problem(planted::kOneSurface, "");
  const Measured measured = admit(problem);
  const simulation::SimulationSettings late =
      planted::simulation(planted::kOneSurface, "  time_skew: {delay: 0.1}\n");
  const auto costs = costsInUse(measured, problem.simulation, late, 0.99);
  // 0.1 s at 17 kPa/s. The static curve lies between filling and venting, which are equally fast.
  EXPECT_NEAR(costOf(costs, "ramp"), 1700, 300);
  // A half sine of 310 kPa in 0.6 s. It is steepest in the first 0.1 s: 310 kPa sin(pi / 6).
  EXPECT_NEAR(costOf(costs, "stance"), 155e3, 15e3);
  EXPECT_NEAR(costs.front().after, 0.1 * costs.front().before, 1e-6);
}

TEST(CostsInUse, OfCreepGrowWithStanding) {
  const DiscrepancyProblem problem = planted::problem(planted::kOneSurface, "");
  const Measured measured = admit(problem);
  const simulation::SimulationSettings creeping =
      planted::simulation(planted::kOneSurface, "  creep: {per_decade: 0.04}\n");
  const auto costs = costsInUse(measured, problem.simulation, creeping, 0);
  EXPECT_GT(costOf(costs, "standing"), 1.5 * costOf(costs, "ramp"));
  EXPECT_LT(costOf(costs, "standing"), 0.2 * 310e3);
  EXPECT_EQ(costs.front().after, costs.front().before);
}

}  // namespace
}  // namespace fsr::discrepancy
