// How often TaxelWatch speaks about a healthy sheet: the stated false-alarm rate, on simulated sheets that
// scatter, lag, creep and make noise, cycled between rest and full pressure on the flat and on a bend.
#include <gtest/gtest.h>

#include <cmath>

#include "fsr_pressure_map/health/taxel_watch.h"
#include "fsr_pressure_map/simulation/sensor_chain.h"
#include "fsr_pressure_map/simulation/simulation_settings.h"

namespace {

constexpr double kRate = 10;       // [Hz]
constexpr double kCycle = 47;      // [s]: no multiple of the window
constexpr double kPeak = 600e3;    // [Pa]
constexpr double kDuration = 600;  // of each sheet: 60 windows [s]

// Verdicts on a sheet that has nothing.
std::size_t alarms(const std::string& file, std::uint64_t seed, const fsr::Surface& surface) {
  fsr::SimulationSettings settings = fsr::readSimulationFile(FSR_SOURCE_DIR "/config/simulation/" + file);
  settings.seed = seed;
  fsr::SensorChain chain(settings);
  chain.mount(surface);
  fsr::TaxelWatch watch(settings.layout.size, chain.fullScale());
  std::uint64_t number = 0;
  std::size_t found = 0;
  for (double time = 0; time < kDuration; time += 1 / kRate) {
    const double pressure = kPeak * 0.5 * (1 - std::cos(2 * M_PI * time / kCycle));
    watch.observe(chain.read({time, pressure, number++}).data(), time);
    for (const std::uint16_t flags : watch.flags()) found += flags != 0;
  }
  return found;
}

// 3 files x 8 sheets x 60 windows x 70 taxels = 100,800 windows of a taxel. None flagged: the rate is below
// 3 / 100,800 = 3.0e-5 with 95 % confidence (rule of three).
TEST(TaxelWatchAlarms, NoHealthyTaxelIsFlaggedInAHundredThousandWindows) {
  const fsr::Surface flat{"flat", 1, {fsr::Curvature{}}, {}};
  const fsr::Surface bent{"cylinder_5cm", 1, {fsr::Curvature{20, 0, 0}}, {}};
  for (const std::string file : {"paper.yaml", "demo.yaml", "hot.yaml"}) {
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
      EXPECT_EQ(alarms(file, seed, seed % 2 == 0 ? flat : bent), 0u) << file << ", seed " << seed;
    }
  }
}

}  // namespace
