#include "session/propose.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "session/example_plans.h"
#include "session/losses.h"
#include "session/plan_report.h"
#include "session/plan_steps.h"

namespace fsr::session {
namespace {

using namespace example_plans;

PlanRequest request(Purpose purpose, double minutes) {
  PlanRequest request;
  request.purpose = purpose;
  request.time = 60 * minutes;
  for (const PlannedSurface& one : shipped("paper").surfaces) request.surfaces.push_back(one.surface);
  return request;
}

const Purpose kPurposes[] = {Purpose::kPerCurvature, Purpose::kHistory, Purpose::kDiscrepancy,
                             Purpose::kFieldCheck};

std::vector<std::string> namesOf(const SessionPlan& plan) {
  std::vector<std::string> names;
  for (const PlannedSurface& one : plan.surfaces) names.push_back(one.surface.name);
  return names;
}

TEST(Proposal, FitsTheTimeAndIsAPlanThatCanBeRead) {
  for (const Purpose purpose : kPurposes) {
    for (const double minutes : {9, 12, 15, 20, 30, 45, 60, 90, 120, 240, 480, 1000}) {
      const SessionPlan plan = proposePlan(request(purpose, minutes)).plan;
      EXPECT_LE(sessionDuration(plan), 60 * minutes + 1e-6) << name(purpose) << " " << minutes;
      EXPECT_NO_THROW(planFrom(planText(plan)));
      EXPECT_EQ(plan.purpose, purpose);
    }
  }
}

TEST(Proposal, UsesTheTimeThatThereIs) {
  for (const Purpose purpose : kPurposes) {
    double last = 0;
    for (const double minutes : {20, 60, 120, 480}) {
      const ProposedPlan proposed = proposePlan(request(purpose, minutes));
      const double duration = sessionDuration(proposed.plan), whole = sessionDuration(proposed.whole);
      EXPECT_GE(duration, std::min(0.6 * 60 * minutes, whole) - 1e-6) << name(purpose) << " " << minutes;
      EXPECT_GE(duration, last);
      last = duration;
    }
  }
}

TEST(Proposal, IsWholeWhereThereIsTimeEnough) {
  for (const Purpose purpose : kPurposes) {
    const ProposedPlan proposed = proposePlan(request(purpose, 1000));
    EXPECT_EQ(sessionDuration(proposed.plan), sessionDuration(proposed.whole));
    EXPECT_TRUE(lacksBeside(proposed.whole, proposed.plan).empty());
  }
}

TEST(Proposal, ForDiscrepancyIn90MinutesKeepsWhatNamesALoopAndAMount) {
  const ProposedPlan proposed = proposePlan(request(Purpose::kDiscrepancy, 90));
  const Prospects prospects = prospectsOf(proposed.plan);
  for (const char* id : {"hysteresis", "creep", "relaxation", "time_skew", "repositioning", "break_in"})
    EXPECT_TRUE(std::count(prospects.told.begin(), prospects.told.end(), id)) << id;
  EXPECT_TRUE(proposed.plan.breaks.empty());
  EXPECT_TRUE(prospects.first_again);
  EXPECT_FALSE(lacksBeside(proposed.whole, proposed.plan).empty());
}

TEST(Proposal, ForDiscrepancyWithAThermometerAndADayTellsAll) {
  PlanRequest day = request(Purpose::kDiscrepancy, 480);
  day.thermometer = true;
  for (const UntoldEffect& effect : prospectsOf(proposePlan(day).plan).untold)
    EXPECT_FALSE(effect.by_plan) << effect.id << " " << effect.reason;
}

TEST(Proposal, ForHistoryLeavesOutProtocolsAtAnyLength) {
  for (const double minutes : {20, 60, 120}) {
    EXPECT_TRUE(prospectsOf(proposePlan(request(Purpose::kHistory, minutes)).plan).history) << minutes;
  }
}

TEST(Proposal, KeepsTheFlatAndTheMostBentSurfaceLongest) {
  const SessionPlan plan = proposePlan(request(Purpose::kPerCurvature, 40)).plan;
  const std::vector<std::string> names = namesOf(plan);
  ASSERT_GE(names.size(), 2u);
  ASSERT_LT(names.size(), 6u);
  EXPECT_EQ(names[0], "flat");
  EXPECT_EQ(names[1], "cylinder_5cm");
}

TEST(Proposal, FitsTheChamberAndThePeak) {
  PlanRequest small = request(Purpose::kDiscrepancy, 90);
  small.peak = 200e3;
  small.chamber_limit = 230e3;
  const SessionPlan plan = proposePlan(small).plan;
  EXPECT_NEAR(largestPeak(plan), 200e3, 1);
  EXPECT_LE(conditioningPeak(plan), 230e3);
  // Times stay, so that the plan takes as long as that for 620 kPa.
  const double large = sessionDuration(proposePlan(request(Purpose::kDiscrepancy, 90)).plan);
  EXPECT_NEAR(sessionDuration(plan), large, 0.02 * large);
}

TEST(Proposal, RefusesAPeakWhoseConditioningTheChamberCannotDo) {
  PlanRequest high = request(Purpose::kDiscrepancy, 90);
  high.peak = 750e3;
  EXPECT_EQ(
      messageOf([&] { proposePlan(high); }),
      "--peak is 750, but the conditioning at 110 % of it would pass the 793 kPa of the chamber; give at "
      "most 720");
  high.peak = 720e3;
  EXPECT_EQ(messageOf([&] { proposePlan(high); }), "no error");
}

TEST(Proposal, NamesTheSmallestTimeThatWouldDo) {
  for (const Purpose purpose : kPurposes) {
    const std::string message = messageOf([&] { proposePlan(request(purpose, 3)); });
    ASSERT_TRUE(contains(message, "--minutes is 3, but one cycle on flat takes ")) << message;
    const double least = std::stod(message.substr(message.rfind(' ') + 1));
    EXPECT_EQ(messageOf([&] { proposePlan(request(purpose, least)); }), "no error") << message;
    EXPECT_TRUE(contains(messageOf([&] { proposePlan(request(purpose, least - 0.1)); }), "give at least"));
    EXPECT_LE(sessionDuration(proposePlan(request(purpose, least)).plan), 60 * least);
  }
}

}  // namespace
}  // namespace fsr::session
