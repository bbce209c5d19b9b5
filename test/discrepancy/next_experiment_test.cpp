// Tests which experiment is recommended.

#include "discrepancy/prove/next_experiment.h"

#include <gtest/gtest.h>

#include "discrepancy/planted.h"
#include "simulation/effects/effect_library.h"

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

TEST(NextExperiment, TakesHoursWhereWearIsAmongTheExplanations) {
  simulation::EnabledEffect wear = usual("wear");
  wear.values["loss"] = 0.3;
  const auto next = nextExperiment(rig(), {{wear}, {usual("drift")}, {usual("break_in")}}, {}, 1e-3);
  ASSERT_EQ(next.size(), 1u);
  EXPECT_EQ(next[0].protocol, "hours_apart");
  EXPECT_NE(next[0].sentence.find("8 hours"), std::string::npos) << next[0].sentence;
  EXPECT_GT(next[0].separation, 0);
}

TEST(NextExperiment, IsNoneForOneExplanation) {
  EXPECT_TRUE(nextExperiment(rig(), {{usual("wear")}}, {}, 1e-3).empty());
}

}  // namespace
}  // namespace fsr::discrepancy
