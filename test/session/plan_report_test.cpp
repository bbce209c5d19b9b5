#include "session/plan.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "dataset/conditioning.h"
#include "session/example_plans.h"
#include "settings/text.h"

namespace fsr::session {
namespace {

using namespace example_plans;

std::string limitsText(const SessionPlan& plan) {
  return settings::joined(limitsOf(plan), "\n");
}

// What `discrepancy` itself names in recordings of the shipped plans with these properties.
TEST(PlanReport, NamesTheEffectsThatEachShippedPlanTells) {
  using Names = std::vector<std::string>;
  const Names always = {"seal_leak",    "dead_taxel", "row_fault",  "column_fault",
                        "mains_pickup", "saturation", "stuck_taxel"};
  const std::pair<const char*, Names> kMore[] = {
      {"paper", {}},
      {"field_check", {"repositioning", "break_in"}},
      {"every_effect",
       {"time_skew", "repositioning", "hysteresis", "creep", "relaxation", "temperature", "break_in", "wear",
        "drift"}}};
  for (const auto& [plan, more] : kMore) {
    Names expected = always, told = effectsToldBy(shipped(plan));
    expected.insert(expected.end(), more.begin(), more.end());
    std::sort(expected.begin(), expected.end());
    std::sort(told.begin(), told.end());
    EXPECT_EQ(told, expected) << plan;
  }
}

TEST(PlanReport, SaysWhatThePapersProtocolCannotTell) {
  const std::string limits = limitsText(shipped("paper"));
  EXPECT_TRUE(
      holds(limits, {"another mount: no surface is mounted twice", "hysteresis", "memory of the sheet",
                     "tare", "temperature", "not conditioned", "below 0 and above 20 1/m", "above 620 kPa",
                     "at most 85.7 % of new mounts (6 mounts); 95 % needs 19"}));
  EXPECT_FALSE(holds(limits, {"between surfaces"}));
}

// Each piece of a plan that is left out costs what it is there for, and nothing is lacking beside itself.
TEST(PlanReport, SaysWhatAPlanLacksBesideALongerOne) {
  struct Case {
    const char* lost;
    void (*leave_out)(SessionPlan&);
  };
  const Case kCases[] = {
      {"another mount (surfaces: 1",
       [](SessionPlan& plan) {
         for (PlannedSurface& one : plan.surfaces) one.mounts = 1;
       }},
      {"Ageing and drift", [](SessionPlan& plan) { plan.repeat_first = false; }},
      {"between surfaces (surfaces: 1", [](SessionPlan& plan) { plan.surfaces.pop_back(); }},
      {"below 0 and above 14.3 1/m",
       [](SessionPlan& plan) { plan.surfaces.erase(plan.surfaces.begin() + 1); }},
      {"longest [s]: 10", [](SessionPlan& plan) { plan.program.pop_back(); }},
      {"wear", [](SessionPlan& plan) { plan.breaks.clear(); }},
      {"The influence of the temperature", [](SessionPlan& plan) { plan.thermometer = false; }},
      {"not conditioned", [](SessionPlan& plan) { plan.conditioning.cycles = 0; }},
      {"tare", [](SessionPlan& plan) { plan.rest.before = 0; }},
      {"one protocol", [](SessionPlan& plan) { plan.program.resize(1); }},
  };
  const SessionPlan whole = shipped("every_effect");
  for (const Case& one : kCases) {
    SessionPlan less = whole;
    one.leave_out(less);
    const std::string report = planReport(less);  // "... (surfaces: 1)" is told, but less well
    EXPECT_TRUE(holds(limitsText(less), {one.lost}) || holds(report, {std::string(one.lost) + ")"}))
        << report;
  }
}

TEST(PlanReport, AsksFor19MountsForIntervalsOf95Percent) {
  SessionPlan plan = planFrom(kSmall);
  plan.surfaces[0].mounts = 17;
  EXPECT_TRUE(holds(limitsText(plan), {"95 % needs"}));
  plan.surfaces[0].mounts = 18;
  EXPECT_FALSE(holds(limitsText(plan), {"95 % needs"}));
}

TEST(PlanReport, SaysWhatIsNeeded) {
  EXPECT_TRUE(holds(planReport(shipped("every_effect")),
                    {"4 h 37 min", "Chamber: up to 682 kPa.", "A thermometer",
                     "Break of 2 h 0 min behind mount 4.", "discrepancy can name", "They cannot tell:"}));
}

TEST(PlanReport, RoundsTimesUp) {
  EXPECT_EQ(timeText(60), "1 min");
  EXPECT_EQ(timeText(61), "2 min");
  EXPECT_EQ(timeText(3600), "1 h 0 min");
}

TEST(PlannedConditioning, IsWhatIsRecognisedInRecordings) {
  const SessionPlan usual;
  const dataset::ConditioningOptions recognised;
  EXPECT_EQ(usual.conditioning.share_of_peak, recognised.share_of_peak);
  EXPECT_EQ(usual.tolerance.peak, recognised.tolerance);
  EXPECT_GE(usual.conditioning.cycles, recognised.cycles);
}

}  // namespace
}  // namespace fsr::session
