#include "simulation/portrait.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "fsr_pressure_map/settings/input_error.h"
#include "support/simulated_rig.h"

namespace {

using fsr::simulation::Portrait;
using fsr::simulation::withEffect;
using test_support::rig;

double largest(const std::vector<double>& values) {
  double result = 0;
  for (const double value : values) result = std::max(result, std::abs(value));
  return result;
}

TEST(Portrait, ShowsNothingWhereNothingDiffers) {
  const auto settings = rig("", 3, 4);
  const Portrait portrait = portray(settings, settings);
  EXPECT_EQ(portrait.response.size(), 4u);
  EXPECT_EQ(largest(portrait.loop[0].y), 0);
  EXPECT_EQ(largest(portrait.hold[0].y), 0);
  EXPECT_EQ(largest(portrait.gas_change), 0);
  EXPECT_EQ(portrait.disc.size(), 12u);
  EXPECT_GT(portrait.disc[5], portrait.disc[0]);
}

TEST(Portrait, ShowsALoopInCyclesAndCreepInAHold) {
  const auto core = rig("", 3, 4);
  const Portrait loop = portray(withEffect(core, "hysteresis"), core),
                 creep = portray(withEffect(core, "creep"), core);
  const auto [low, high] = std::minmax_element(loop.loop[0].y.begin(), loop.loop[0].y.end());
  EXPECT_LT(*low, -0.01);
  EXPECT_GT(*high, 0.01);
  const auto& held = creep.hold[0];
  const auto at = [&](double time) { return held.y[static_cast<std::size_t>(time / 0.5)]; };
  EXPECT_GT(at(900), at(300) + 0.001);  // rises while held
  EXPECT_LT(at(1700), at(1000));        // fades at rest
}

TEST(Portrait, PutsTheMostChangedTaxelFirst) {
  const auto core = rig("", 3, 4);
  const Portrait portrait = portray(withEffect(core, "dead_taxel"), core);
  EXPECT_GT(largest(portrait.loop[0].y), 0.3);
  EXPECT_EQ(
      std::count_if(portrait.gas_change.begin(), portrait.gas_change.end(), [](double y) { return y != 0; }),
      1);
}

TEST(Portrait, KnowsWhatBelongsToEveryBentMatrix) {
  const auto settings = rig("  creep: {}\n  bending_gain: {}\n  white_noise: {}\n");
  std::vector<std::string> ids;
  for (const auto& effect : coreOf(settings).effects) ids.push_back(effect.id);
  EXPECT_EQ(ids, (std::vector<std::string>{"bending_gain", "static_curve", "converter", "white_noise"}));
  EXPECT_EQ(withEffect(settings, "creep").effects.size(), settings.effects.size());
  EXPECT_EQ(withoutEffect(settings, "creep").effect("creep"), nullptr);
  EXPECT_THROW(withEffect(settings, "humidity"), fsr::settings::InputError);
  EXPECT_THROW(withEffect(settings, "hysterese"), fsr::settings::InputError);
}

}  // namespace
