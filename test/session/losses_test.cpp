// What a plan can tell is asked of the functions that train and discrepancy use. These tests change a plan
// and see whether the answer follows.

#include "session/losses.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "discrepancy/samples/available_evidence.h"
#include "session/example_plans.h"
#include "session/plan_report.h"
#include "simulation/effects/effect_library.h"

namespace fsr::session {
namespace {

using namespace example_plans;

std::string joined(const std::vector<std::string>& sentences) {
  std::string text;
  for (const std::string& sentence : sentences) text += sentence + "\n";
  return text;
}

// The cut whose words contain `what`.
Cut cutCalled(const std::vector<Cut>& cuts, const std::string& what) {
  for (const Cut& cut : cuts) {
    if (contains(cut.what, what)) return cut;
  }
  ADD_FAILURE() << "no cut " << what;
  return {};
}

TEST(Prospects, EveryEffectOfAGasChamberCanBeNamedWithTheShippedPlan) {
  const Prospects prospects = prospectsOf(shipped("every_effect"));
  EXPECT_EQ(prospects.training, "");
  EXPECT_EQ(prospects.discrepancy, "");
  for (const UntoldEffect& effect : prospects.untold)
    EXPECT_FALSE(effect.by_plan) << effect.id << effect.reason;
  EXPECT_GE(prospects.told.size(), 16u);
  EXPECT_GE(prospects.fewest_cycles, 10u);
  EXPECT_GT(prospects.hold_out, 0u);
  EXPECT_TRUE(prospects.history);
  EXPECT_TRUE(prospects.tare);
  EXPECT_TRUE(prospects.first_again);
  EXPECT_EQ(prospects.remounted, 4u);
  EXPECT_EQ(prospects.inner(), 2u);
}

// The plan is asked for nothing that no plan gives, and for all that the library says an effect needs.
TEST(Prospects, EachEffectOfTheLibraryIsToldOrHasAReason) {
  for (const char* name : {"paper", "every_effect", "field_check"}) {
    const Prospects prospects = prospectsOf(shipped(name));
    std::size_t expected = 0;
    for (const simulation::EffectEntry& entry : simulation::EffectLibrary::shipped().entries())
      expected += entry.info.kind == simulation::EffectKind::kBase || entry.info.with_bending ? 0 : 1;
    EXPECT_EQ(prospects.told.size() + prospects.untold.size(), expected) << name;
    for (const UntoldEffect& effect : prospects.untold) EXPECT_FALSE(effect.reason.empty()) << effect.id;
  }
}

TEST(Prospects, ThePapersProtocolTellsNoLoopNoMountAndNoMemory) {
  const Prospects prospects = prospectsOf(shipped("paper"));
  const std::string limits = joined(limitsOf(prospects));
  EXPECT_TRUE(contains(limits, "hysteresis, creep and relaxation alone. They need two ramp rates."))
      << limits;
  EXPECT_TRUE(contains(limits, "repositioning alone. No surface is mounted twice."));
  EXPECT_TRUE(
      contains(limits, "train learns no memory of the sheet: all cycles of the bags have one protocol"));
  EXPECT_TRUE(contains(
      limits, "Curvatures below 0 and above 20 1/m are extrapolated, and so are pressures above 620"));
  EXPECT_TRUE(contains(limits, "The sheet is not conditioned"));
  EXPECT_TRUE(contains(limits, "at most 85.7 % of new mounts (6 mounts); 95 % needs 19 mounts."));
  EXPECT_FALSE(prospects.history);
  EXPECT_FALSE(prospects.tare);
  EXPECT_EQ(prospects.remounted, 0u);
}

TEST(Prospects, NineteenMountsCarryIntervalsOf95Percent) {
  SessionPlan plan = planFrom(kSmall);
  plan.surfaces[0].mounts = 17;
  EXPECT_LT(prospectsOf(plan).coverage(), 0.95);
  plan.surfaces[0].mounts = 18;
  const Prospects enough = prospectsOf(plan);
  EXPECT_EQ(enough.mounts, 19u);
  EXPECT_DOUBLE_EQ(enough.coverage(), 0.95);
  EXPECT_FALSE(contains(joined(limitsOf(enough)), "95 % needs"));
}

TEST(Prospects, ASingleCycleIsRefusedByDiscrepancyWithItsOwnSentence) {
  SessionPlan plan = planFrom(kSmall);
  std::get<simulation::ChamberProtocol>(plan.program[0]).cycles = 1;
  plan.repeat_first = false;
  EXPECT_TRUE(contains(joined(limitsOf(prospectsOf(plan))), "at least 3 are needed"));
}

TEST(Cuts, AnOutermostSurfaceCostsItsRangeOfCurvature) {
  const SessionPlan plan = shipped("paper");
  const std::vector<Cut> cuts = cutsOf(plan, prospectsOf(plan));
  EXPECT_TRUE(contains(joined(cutCalled(cuts, "cylinder_5cm").losses),
                       "Curvatures from 14.3 to 20 1/m are extrapolated"));
  EXPECT_TRUE(
      contains(joined(cutCalled(cuts, "flat").losses), "Curvatures from 0 to 7.69 1/m are extrapolated"));
  const Cut inner = cutCalled(cuts, "cylinder_9cm");
  EXPECT_FALSE(contains(joined(inner.losses), "extrapolated"));
  EXPECT_TRUE(contains(joined(inner.losses), "between surfaces is measured on 3 surfaces instead of 4"));
  EXPECT_NEAR(inner.saved, 180 + 10 * (2 + 2 * 620.0 / 17), 1e-6);
}

TEST(Cuts, OfThePlanForEveryEffectNameWhatIsLost) {
  const SessionPlan plan = shipped("every_effect");
  const std::vector<Cut> cuts = cutsOf(plan, prospectsOf(plan));
  const std::string no_break = joined(cutCalled(cuts, "the break").losses);
  EXPECT_TRUE(contains(no_break, "drift")) << no_break;
  EXPECT_TRUE(contains(no_break, "wear"));
  EXPECT_NEAR(cutCalled(cuts, "the break").saved, 7200, 1e-6);
  const std::string cold = joined(cutCalled(cuts, "the thermometer").losses);
  EXPECT_TRUE(contains(cold, "temperature")) << cold;
  EXPECT_EQ(cutCalled(cuts, "the thermometer").saved, 0);
  EXPECT_TRUE(contains(joined(cutCalled(cuts, "the hold").losses),
                       "The longest memory that train can learn is 10 s"));
  EXPECT_TRUE(contains(joined(cutCalled(cuts, "the conditioning").losses), "not conditioned"));
  EXPECT_TRUE(contains(joined(cutCalled(cuts, "at the end").losses), "Ageing and drift"));
  EXPECT_TRUE(contains(joined(cutCalled(cuts, "mounted once").losses), "measured on 1 surface instead of 4"));
  for (const Cut& cut : cuts) EXPECT_GE(cut.saved, 0) << cut.what;
}

TEST(Cuts, WithoutRemountsOnePieceOfEvidenceAfterTheOtherIsLost) {
  const SessionPlan plan = shipped("field_check");
  const std::string losses = joined(cutCalled(cutsOf(plan, prospectsOf(plan)), "at the end").losses);
  EXPECT_TRUE(contains(losses, "break_in alone. It needs remounts.")) << losses;
  EXPECT_TRUE(contains(losses, "repositioning alone. No surface is mounted twice."));
  EXPECT_TRUE(contains(losses, "cannot assess a tare"));
}

TEST(Losses, AreNoneBetweenEqualPlans) {
  for (const char* name : {"paper", "every_effect", "field_check"}) {
    const Prospects prospects = prospectsOf(shipped(name));
    EXPECT_EQ(joined(lossesBetween(prospects, prospects)), "") << name;
  }
}

TEST(PlanReport, SaysWhatIsNeededWhatIsToldAndWhatACutCosts) {
  const std::string report = planReport(shipped("every_effect"));
  for (const char* part :
       {"4 h 37 min", "Chamber: up to 682 kPa.", "A thermometer", "Break of 2 h 0 min behind mount 4.",
        "discrepancy can name", "They cannot tell:", "What a cut costs:"})
    EXPECT_TRUE(contains(report, part)) << part;
}

TEST(PlanReport, RoundsTimesUp) {
  EXPECT_EQ(timeText(60), "1 min");
  EXPECT_EQ(timeText(61), "2 min");
  EXPECT_EQ(timeText(3600), "1 h 0 min");
}

}  // namespace
}  // namespace fsr::session
