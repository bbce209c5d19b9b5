#include "blind/identifiability.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "blind/hand_plan.h"

namespace blind {
namespace {

const Told& hiddenOf(const BlindCase& made) {
  return made.identifiable.effects.at(0);
}

bool confused(const Told& told, const char* id) {
  return std::count(told.confused_with.begin(), told.confused_with.end(), id) > 0;
}

RigPlan equalCycles() {
  RigPlan plan = handPlan({0});
  addStay(plan, 0, 8, false);
  return plan;
}

RigPlan richCycles(const std::vector<int>& radii_mm, int rounds) {
  RigPlan plan = handPlan(radii_mm);
  plan.mounts = static_cast<std::size_t>(rounds);
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t surface = 0; surface < radii_mm.size(); ++surface) addStay(plan, surface, 6, true);
  }
  return plan;
}

TEST(Identifiable, IsNoLoopAtOnePaceBecauseAShortMemoryDoesTheSame) {
  const BlindCase made = makeCase(handCase("one pace", equalCycles(), "hysteresis", "duhem"));
  EXPECT_FALSE(hiddenOf(made).could_be_told);
  EXPECT_EQ(hiddenOf(made).reason, "one_pace");
  EXPECT_TRUE(confused(hiddenOf(made), "creep"));
}

TEST(Identifiable, IsALoopUnderTwoPacesWithDwells) {
  const BlindCase made = makeCase(handCase("two paces", richCycles({0}, 1), "hysteresis", "duhem"));
  EXPECT_TRUE(hiddenOf(made).could_be_told) << hiddenOf(made).reason;
  EXPECT_TRUE(hiddenOf(made).confused_with.empty());
}

TEST(Identifiable, IsNoDriftWithoutAThermometer) {
  RigPlan plan = richCycles({0}, 2);
  plan.thermometer = false;
  const BlindCase without = makeCase(handCase("drift", plan, "drift", "exponential"));
  EXPECT_FALSE(hiddenOf(without).could_be_told);
  EXPECT_EQ(hiddenOf(without).reason, "no_thermometer");
  EXPECT_TRUE(confused(hiddenOf(without), "temperature"));
  plan.thermometer = true;
  const BlindCase with = makeCase(handCase("drift", plan, "drift", "exponential"));
  EXPECT_FALSE(confused(hiddenOf(with), "temperature"));
}

TEST(Identifiable, IsNoTemperatureWithoutAThermometer) {
  RigPlan plan = richCycles({0, 60}, 1);
  plan.room.drift = 11;
  plan.room.shape = "swing";
  const BlindCase with = makeCase(handCase("warm", plan, "temperature", "quadratic"));
  EXPECT_GT(hiddenOf(with).nats, 100);
  EXPECT_TRUE(hiddenOf(with).could_be_told) << hiddenOf(with).reason;
  plan.thermometer = false;
  const BlindCase without = makeCase(handCase("warm", plan, "temperature", "quadratic"));
  EXPECT_FALSE(hiddenOf(without).could_be_told);
  EXPECT_EQ(hiddenOf(without).reason, "no_thermometer");
}

TEST(Identifiable, IsRepositioningOnlyWhereASurfaceIsMountedAgain) {
  const BlindCase once = makeCase(handCase("mounts", richCycles({0}, 1), "repositioning", "tilt"));
  EXPECT_FALSE(hiddenOf(once).could_be_told);
  EXPECT_EQ(hiddenOf(once).reason, "one_mount");
  const BlindCase thrice = makeCase(handCase("mounts", richCycles({0}, 3), "repositioning", "tilt"));
  EXPECT_TRUE(hiddenOf(thrice).could_be_told) << hiddenOf(thrice).reason;
}

TEST(Identifiable, IsSaturationOnlyWhereTwoSurfacesBendAtOneCode) {
  const BlindCase one = makeCase(handCase("rail", richCycles({0}, 1), "saturation", "soft_rail"));
  EXPECT_FALSE(hiddenOf(one).could_be_told);
  EXPECT_EQ(hiddenOf(one).reason, "one_surface");
  const BlindCase three = makeCase(handCase("rail", richCycles({0, 110, 50}, 1), "saturation", "soft_rail"));
  EXPECT_TRUE(hiddenOf(three).could_be_told) << hiddenOf(three).reason;
}

TEST(Identifiable, IsNothingThatIsTooSmall) {
  CaseSpec spec = handCase("small", richCycles({0}, 1), "hysteresis", "duhem");
  spec.effects[0].strength = 1e-3;
  spec.noise = 0.01;
  const BlindCase made = makeCase(spec);
  EXPECT_FALSE(hiddenOf(made).could_be_told);
  EXPECT_EQ(hiddenOf(made).reason, "too_small");
  EXPECT_LT(hiddenOf(made).nats, kNats);
}

TEST(Identifiable, GrowsWithTheSquareOfTheSize) {
  CaseSpec spec = handCase("square", richCycles({0}, 1), "hysteresis", "duhem");
  spec.noise = 0.005;
  spec.effects[0].strength = 0.1;
  const double small = hiddenOf(makeCase(spec)).nats;
  spec.effects[0].strength = 0.2;
  EXPECT_NEAR(hiddenOf(makeCase(spec)).nats / small, 4, 0.3);
}

TEST(Identifiable, EveryEffectOfTheLibraryIsJudgedOnce) {
  const BlindCase made = makeCase(handCase("all", equalCycles(), "", ""));
  std::vector<std::string> judged;
  for (const Told& told : made.identifiable.effects) {
    judged.push_back(told.id);
    EXPECT_EQ(told.could_be_told, told.reason.empty()) << told.id;
    EXPECT_FALSE(told.hidden);
  }
  std::vector<std::string> library = hiddenIds();
  library.erase(std::remove(library.begin(), library.end(), "foreign"), library.end());
  EXPECT_EQ(judged, library);
}

TEST(Identifiable, APairIsJudgedWithItsPartnerPresent) {
  CaseSpec spec = handCase("pair", richCycles({0}, 1), "hysteresis", "duhem");
  spec.effects.push_back({"seal_leak", "porous", {}});
  const BlindCase made = makeCase(spec);
  ASSERT_GE(made.identifiable.effects.size(), 2u);
  EXPECT_EQ(made.identifiable.effects[0].id, "hysteresis");
  EXPECT_EQ(made.identifiable.effects[1].id, "seal_leak");
  EXPECT_TRUE(made.identifiable.effects[0].hidden && made.identifiable.effects[1].hidden);
}

}  // namespace
}  // namespace blind
