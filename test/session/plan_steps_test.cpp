#include "session/plan_steps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "session/example_plans.h"
#include "simulation/pressure_profile.h"

namespace fsr::session {
namespace {

using namespace example_plans;

std::vector<std::size_t> orderOf(const SessionPlan& plan) {
  std::vector<std::size_t> order;
  for (const PlannedMount& mount : mountOrder(plan)) order.push_back(mount.surface);
  return order;
}

TEST(MountOrder, ComesInRoundsAndRepeatsTheFirstSurfaceLast) {
  SessionPlan plan = shipped("every_effect");
  plan.drawn_order = false;
  plan.surfaces[2].mounts = 3;
  EXPECT_EQ(orderOf(plan), (std::vector<std::size_t>{0, 1, 2, 3, 0, 1, 2, 3, 2, 0}));
  plan.repeat_first = false;
  EXPECT_EQ(orderOf(plan), (std::vector<std::size_t>{0, 1, 2, 3, 0, 1, 2, 3, 2}));
}

TEST(MountOrder, IsDrawnByTheSeed) {
  SessionPlan plan = shipped("every_effect");
  std::set<std::vector<std::size_t>> orders;
  for (plan.seed = 0; plan.seed < 200; ++plan.seed) {
    const std::vector<std::size_t> order = orderOf(plan);
    EXPECT_EQ(order, orderOf(plan));
    orders.insert(order);
    EXPECT_EQ(order.front(), 0u);
    EXPECT_EQ(order.back(), 0u);
    std::map<std::size_t, std::size_t> visits;
    for (const std::size_t surface : order) ++visits[surface];
    EXPECT_EQ(visits, (std::map<std::size_t, std::size_t>{{0, 3}, {1, 2}, {2, 2}, {3, 2}}));
    // A round holds each surface once.
    EXPECT_EQ(std::set<std::size_t>(order.begin(), order.begin() + 4).size(), 4u);
    for (std::size_t m = 1; m < order.size(); ++m) EXPECT_NE(order[m], order[m - 1]) << "seed " << plan.seed;
  }
  EXPECT_GT(orders.size(), 50u);
}

// 180 s to put it on; 5 cycles of 68 s to 660 kPa; 30 s, 2 cycles of 62 s, 30 s; 180 s; the same once more.
TEST(SessionSteps, LastAsLongAsTheirPartsByHand) {
  const SessionPlan plan = planFrom(std::string(kSmall) + "conditioning: {rate: 20000}\n");
  EXPECT_NEAR(recordingDuration(plan), 30 + 2 * 62 + 30, 1e-9);
  EXPECT_NEAR(sessionDuration(plan), 2 * (180 + 184) + 5 * 68, 1e-9);
  const std::vector<SessionStep> steps = sessionSteps(plan);
  ASSERT_EQ(steps.size(), 1u + 5 + 4 + 5);
  EXPECT_EQ(steps[0].kind, StepKind::kMount);
  EXPECT_EQ(steps[1].kind, StepKind::kCondition);
  EXPECT_NEAR(steps[1].peak, 660e3, 1e-6);
  EXPECT_FALSE(steps[1].recorded);
  EXPECT_EQ(steps[5].number, 5u);
  EXPECT_EQ(steps[5].of, 5u);
  EXPECT_EQ(steps[6].kind, StepKind::kRest);
  EXPECT_TRUE(steps[6].recorded);
  EXPECT_NEAR(steps[6].begin, 180 + 5 * 68, 1e-9);
  EXPECT_EQ(steps[7].kind, StepKind::kCycle);
  EXPECT_NEAR(steps[7].duration, 62, 1e-9);
  EXPECT_EQ(steps[7].fill_rate, 20e3);
  EXPECT_EQ(steps[7].dwell_peak, 1);
  EXPECT_NEAR(steps[7].peak_error, 30e3, 1e-6);
  EXPECT_EQ(steps[7].rate_error, 0.25);
  EXPECT_EQ(steps[7].dwell_error, 2);
  EXPECT_EQ(steps.back().mount, 2u);
  EXPECT_EQ(steps.back().surface, "flat");
}

TEST(SessionSteps, FollowEachOtherWithoutGapsToTheEndOfTheSession) {
  for (const char* name : {"paper", "every_effect", "field_check"}) {
    const SessionPlan plan = shipped(name);
    double end = 0;
    for (const SessionStep& step : sessionSteps(plan)) {
      EXPECT_NEAR(step.begin, end, 1e-6);
      EXPECT_GT(step.duration, 0);
      end = step.begin + step.duration;
    }
    EXPECT_NEAR(end, sessionDuration(plan), 1e-6) << name;
  }
}

// Every step of a recording shows in the pressure that a rig follows: at its end it stands where the step
// leaves it.
TEST(SessionSteps, DescribeThePressureOfTheProgram) {
  const SessionPlan plan = shipped("every_effect");
  const simulation::PressureProfile profile = pressureProfile(simulatedStations(plan).front().program);
  double begin = -1;
  for (const SessionStep& step : sessionSteps(plan)) {
    if (step.mount != 1 || !step.recorded) continue;
    if (begin < 0) begin = step.begin;
    const double end = step.kind == StepKind::kHold ? step.peak : step.kind == StepKind::kLoop ? step.low : 0;
    EXPECT_NEAR(profile.at(step.begin - begin + step.duration), end, 1) << name(step.kind) << step.number;
    double highest = 0;
    for (double t = 0; t <= step.duration; t += 0.05)
      highest = std::max(highest, profile.at(step.begin - begin + t));
    if (step.kind == StepKind::kCycle) {
      EXPECT_NEAR(highest, step.peak, 2e3);
    }
  }
}

TEST(SessionSteps, ABreakIsBehindItsMountAndNotRecorded) {
  const std::vector<SessionStep> steps = sessionSteps(shipped("every_effect"));
  std::vector<SessionStep> breaks;
  std::copy_if(steps.begin(), steps.end(), std::back_inserter(breaks),
               [](const SessionStep& step) { return step.kind == StepKind::kBreak; });
  ASSERT_EQ(breaks.size(), 1u);
  EXPECT_EQ(breaks[0].mount, 4u);
  EXPECT_EQ(breaks[0].duration, 7200);
  EXPECT_FALSE(breaks[0].recorded);
}

TEST(SimulatedStations, HaveTheDatesOfTheSession) {
  const SessionPlan plan = shipped("every_effect");
  const std::vector<SessionStep> steps = sessionSteps(plan);
  double time = 0;
  std::uint32_t mount = 0;
  for (const simulation::Station& station : simulatedStations(plan)) {
    time += station.pause;
    const auto first = std::find_if(steps.begin(), steps.end(), [&](const SessionStep& step) {
      return step.mount == mount + 1 && step.recorded;
    });
    ASSERT_NE(first, steps.end());
    EXPECT_NEAR(time, first->begin, 1e-6);
    EXPECT_EQ(station.surface.mount, ++mount);
    EXPECT_EQ(station.surface.name, first->surface);
    time += simulation::pressureProfile(station.program).duration();
  }
  EXPECT_NEAR(time, sessionDuration(plan), 1e-6);
}

}  // namespace
}  // namespace fsr::session
