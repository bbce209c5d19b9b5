#include "simulation/sensor_chain.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "fsr_pressure_map/settings/input_error.h"
#include "simulation/pressure_profile.h"
#include "support/allocation_guard.h"
#include "support/source_dir.h"

namespace {

using fsr::simulation::SensorChain;
using fsr::simulation::SimulationSettings;

SimulationSettings demo() {
  return fsr::simulation::readSimulationFile(test_support::sourceDir() + "/config/simulation/demo.yaml");
}

/// Counts of all scans from `first` to `last` of the paper's cycles at 10 Hz.
std::vector<std::uint16_t> scans(SensorChain& chain, int first, int last) {
  const fsr::simulation::PressureProfile profile = pressureProfile(fsr::simulation::ChamberProtocol{});
  std::vector<std::uint16_t> counts;
  for (int i = first; i < last; ++i) {
    const auto& scan = chain.read({i * 0.1, profile.at(i * 0.1), static_cast<std::uint64_t>(i)});
    counts.insert(counts.end(), scan.begin(), scan.end());
  }
  return counts;
}

TEST(SensorChain, GivesTheSameCountsFromTheSameSettings) {
  SensorChain one(demo()), other(demo());
  const auto counts = scans(one, 0, 1500);
  EXPECT_EQ(scans(other, 0, 1500), counts);
  SimulationSettings reseeded = demo();
  reseeded.seed = 2;
  SensorChain different(reseeded);
  EXPECT_NE(scans(different, 0, 1500), counts);
}

TEST(SensorChain, RefusesTheStateOfAnotherChain) {
  const auto bench =
      fsr::simulation::readSimulationFile(test_support::sourceDir() + "/config/simulation/bench.yaml");
  SensorChain chain(demo()), other(bench);
  EXPECT_THROW(chain.restore(other.state()), fsr::settings::InputError);
}

TEST(SensorChain, RefusesASurfaceOfAnotherSize) {
  SensorChain chain(demo());
  EXPECT_THROW(chain.mount({"limb", 1, std::vector<fsr::matrix::Curvature>(12), {}}),
               fsr::settings::InputError);
  EXPECT_THROW(chain.mount({"unknown", 1, {}, {}}), fsr::settings::InputError);
}

TEST(SensorChain, UsesMostOfTheConvertersRangeWithoutClipping) {
  SensorChain chain(demo());
  const auto counts = scans(chain, 0, 750);
  const auto largest = *std::max_element(counts.begin(), counts.end());
  EXPECT_GT(largest, 2500);
  EXPECT_LT(largest, 4095);
}

}  // namespace
