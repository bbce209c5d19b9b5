// An effect from outside of the package is simulated without any change of the package.

#include <gtest/gtest.h>

#include "fsr_pressure_map/settings/input_error.h"
#include "fsr_pressure_map/simulation/simulate.h"
#include "simulation/settings_text.h"
#include "support/dummy_effect.h"

namespace fsr::simulation {
namespace {

const char* const kRig = R"(
simulation: rig
matrix: {rows: 2, columns: 2}
chamber: {cycles: 1}
effects:
  static_curve: {}
  converter: {}
)";

SimulationSettings read(const std::string& more, std::shared_ptr<const EffectLibrary> library) {
  return readSimulation(settings::Settings::fromText(kRig + more, "rig.yaml"), std::move(library));
}

TEST(AddedEffect, IsReadFromYamlAndSimulated) {
  const SimulationSettings with = read("  rate_gain: {change: 0.1}\n", test_support::libraryWithRateGain());
  EXPECT_EQ(with.effect("rate_gain")->values.at("rate"), 10e3);
  const dataset::Recording changed = simulateSession(with).front();
  const dataset::Recording plain = simulateSession(read("", nullptr)).front();
  ASSERT_EQ(changed.scans(), plain.scans());
  for (std::size_t i = 1; i < plain.scans(); ++i) {
    const double rate = plain.pressure[i] - plain.pressure[i - 1];
    if (plain.pressure[i] < 50e3 || std::abs(rate) < 1e3) continue;
    EXPECT_EQ(changed.scan(i)[0] > plain.scan(i)[0], rate > 0) << "scan " << i;
  }
}

TEST(AddedEffect, IsWrittenBack) {
  const auto library = test_support::libraryWithRateGain();
  const std::string text = simulationText(read("  rate_gain: {change: 0.1}\n", library));
  EXPECT_NE(text.find("rate_gain:\n    change: 0.1"), std::string::npos) << text;
  EXPECT_EQ(simulationText(readSimulation(settings::Settings::fromText(text, "again.yaml"), library)), text);
}

TEST(AddedEffect, IsUnknownToTheLibraryOfThePackage) {
  EXPECT_THROW(read("  rate_gain: {}\n", nullptr), settings::InputError);
  EXPECT_EQ(findEffect("rate_gain"), nullptr);
}

TEST(AddedEffect, MustHaveANameOfItsOwn) {
  EXPECT_THROW(test_support::libraryWithRateGain()->with(test_support::rateGain()), settings::InputError);
}

}  // namespace
}  // namespace fsr::simulation
