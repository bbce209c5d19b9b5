// Which experiment is recommended.

#include "fsr_pressure_map/discrepancy/next_experiment.h"

#include <gtest/gtest.h>

#include "fsr_pressure_map/simulation/effects/effect_library.h"
#include "fsr_pressure_map/simulation/session.h"

namespace fsr {
namespace {

const char* const kRig = R"(
simulation: rig
seed: 7
matrix: {rows: 2, columns: 2}
board: {scan_rate: 2, transducer_rate: 2}
chamber: {cycles: 4}
effects:
  static_curve: {conductance: 3.2e-4, exponent: 0.85}
  bending_preload: {amplitude: 30000}
  bending_gain: {change: -0.15}
  converter: {}
session:
)";

SimulationSettings rig(const std::string& session) {
  return readSimulation(Settings::fromText(kRig + session, "rig.yaml"));
}

const char* const kEvenly =
    "  - {surface: flat, flat: true}\n  - {surface: cylinder_5cm, cylinder: {radius: 0.05, axis: y}, pause: "
    "300}\n";

EnabledEffect usual(const std::string& id) {
  EnabledEffect enabled{id, {}};
  for (const EffectParameter& parameter : findEffect(id)->info.parameters)
    enabled.values[parameter.name] = parameter.usual;
  return enabled;
}

TEST(NextExperiment, TakesHoursWhereWearIsAmongTheExplanations) {
  EnabledEffect wear = usual("wear");
  wear.values["loss"] = 0.3;
  const auto next = nextExperiment(rig(kEvenly), {{wear}, {usual("drift")}, {usual("break_in")}}, {}, 1e-3);
  ASSERT_EQ(next.size(), 1u);
  EXPECT_EQ(next[0].protocol, "hours_apart");
  EXPECT_NE(next[0].sentence.find("8 hours"), std::string::npos) << next[0].sentence;
  EXPECT_GT(next[0].separation, 0);
}

TEST(NextExperiment, IsNoneForOneExplanation) {
  EXPECT_TRUE(nextExperiment(rig(kEvenly), {{usual("wear")}}, {}, 1e-3).empty());
}

}  // namespace
}  // namespace fsr
