#include "session/plan.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "session/example_plans.h"
#include "session/plan_steps.h"

namespace fsr::session {
namespace {

using namespace example_plans;

PlanRequest request(Purpose purpose, double minutes) {
  PlanRequest request;
  request.like.purpose = purpose;
  request.time = 60 * minutes;
  for (const PlannedSurface& one : shipped("paper").surfaces) request.surfaces.push_back(one.surface);
  return request;
}

class Proposal : public testing::TestWithParam<Purpose> {};

TEST_P(Proposal, FitsTheTimeUsesItAndCanBeRead) {
  double last = 0;
  for (const double minutes : {9, 12, 15, 20, 30, 45, 60, 90, 120, 240, 480, 1000}) {
    const ProposedPlan proposed = proposePlan(request(GetParam(), minutes));
    const double duration = sessionDuration(proposed.plan), whole = sessionDuration(proposed.whole);
    EXPECT_LE(duration, 60 * minutes + 1e-6) << minutes;
    EXPECT_GE(duration, last) << minutes;
    EXPECT_GE(duration, minutes < 20 ? 0 : std::min(0.6 * 60 * minutes, whole) - 1e-6) << minutes;
    EXPECT_NO_THROW(planFrom(planText(proposed.plan)));
    EXPECT_EQ(proposed.plan.purpose, GetParam());
    last = duration;
  }
  const ProposedPlan whole = proposePlan(request(GetParam(), 1000));
  EXPECT_EQ(sessionDuration(whole.plan), sessionDuration(whole.whole));
}

TEST_P(Proposal, NamesTheSmallestTimeThatWouldDo) {
  const std::string message = refusal([] { proposePlan(request(GetParam(), 3)); });
  ASSERT_TRUE(holds(message, {"--minutes is 3, but one cycle on flat takes "}));
  const double least = std::stod(message.substr(message.rfind(' ') + 1));
  EXPECT_LE(sessionDuration(proposePlan(request(GetParam(), least)).plan), 60 * least);
  EXPECT_THROW(proposePlan(request(GetParam(), least - 0.1)), settings::InputError);
}

INSTANTIATE_TEST_SUITE_P(Purposes, Proposal,
                         testing::Values(Purpose::kPerCurvature, Purpose::kHistory, Purpose::kDiscrepancy,
                                         Purpose::kFieldCheck),
                         [](const auto& one) { return name(one.param); });

TEST(ProposalForDiscrepancy, In90MinutesKeepsWhatNamesALoopAndAMount) {
  const ProposedPlan proposed = proposePlan(request(Purpose::kDiscrepancy, 90));
  const std::vector<std::string> told = effectsToldBy(proposed.plan);
  for (const char* id : {"hysteresis", "creep", "relaxation", "time_skew", "repositioning", "break_in"})
    EXPECT_TRUE(std::count(told.begin(), told.end(), id)) << id;
  EXPECT_TRUE(proposed.plan.breaks.empty());
  EXPECT_TRUE(proposed.plan.repeat_first);
}

TEST(ProposalForDiscrepancy, WithAThermometerAndADayTellsAsMuchAsTheShippedPlan) {
  PlanRequest day = request(Purpose::kDiscrepancy, 480);
  day.like.thermometer = true;
  EXPECT_EQ(effectsToldBy(proposePlan(day).plan), effectsToldBy(shipped("every_effect")));
}

TEST(ProposalForHistory, HasProtocolsToLeaveOutAtAnyLength) {
  for (const double minutes : {20, 60, 120}) {
    for (const std::string& limit : limitsOf(proposePlan(request(Purpose::kHistory, minutes)).plan))
      EXPECT_FALSE(holds(limit, {"one protocol"})) << minutes;
  }
}

TEST(ProposalPerCurvature, KeepsTheFlatAndTheMostBentSurfaceLongest) {
  const SessionPlan plan = proposePlan(request(Purpose::kPerCurvature, 40)).plan;
  ASSERT_GE(plan.surfaces.size(), 2u);
  ASSERT_LT(plan.surfaces.size(), 6u);
  EXPECT_EQ(plan.surfaces[0].surface.name, "flat");
  EXPECT_EQ(plan.surfaces[1].surface.name, "cylinder_5cm");
}

TEST(ProposalForAPeak, FitsTheChamber) {
  PlanRequest small = request(Purpose::kDiscrepancy, 90);
  small.peak = 200e3;
  small.like.chamber_limit = 230e3;
  const SessionPlan plan = proposePlan(small).plan;
  EXPECT_NEAR(largestPeak(plan), 200e3, 1);
  EXPECT_LE(conditioningPeak(plan), 230e3);
  // Times stay, so that the plan takes as long as that for 620 kPa.
  const double large = sessionDuration(proposePlan(request(Purpose::kDiscrepancy, 90)).plan);
  EXPECT_NEAR(sessionDuration(plan), large, 0.02 * large);
  PlanRequest high = request(Purpose::kDiscrepancy, 90);
  high.peak = 750e3;
  EXPECT_TRUE(holds(refusal([&] { proposePlan(high); }), {"--peak is 750"}));
  high.peak = 720e3;
  EXPECT_NO_THROW(proposePlan(high));
}

}  // namespace
}  // namespace fsr::session
