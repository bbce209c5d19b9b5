// False-alarm rate of TaxelWatch on simulated healthy sheets with scatter, lag, creep and noise, cycled
// between rest and full pressure, flat and bent.
#include <gtest/gtest.h>

#include <cmath>

#include "fsr_pressure_map/health/taxel_watch.h"
#include "fsr_pressure_map/simulation/simulation_settings.h"
#include "simulation/effects/effect_library.h"
#include "simulation/sensor_chain.h"
#include "support/source_dir.h"

namespace {

constexpr double kRate = 10;       // [Hz]
constexpr double kCycle = 47;      // [s]: not a multiple of the window
constexpr double kPeak = 600e3;    // [Pa]
constexpr double kDuration = 600;  // of each sheet: 60 windows [s]

// Number of verdicts on a sheet without a fault.
std::size_t alarms(const std::string& file, std::uint64_t seed, const fsr::matrix::Surface& surface) {
  fsr::simulation::SimulationSettings settings =
      fsr::simulation::readSimulationFile(test_support::sourceDir() + "/config/simulation/" + file);
  settings.seed = seed;
  fsr::simulation::SensorChain chain(settings);
  chain.mount(surface);
  fsr::health::TaxelWatch watch(settings.layout.size, chain.fullScale());
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
  const fsr::matrix::Surface flat{"flat", 1, {fsr::matrix::Curvature{}}, {}};
  const fsr::matrix::Surface bent{"cylinder_5cm", 1, {fsr::matrix::Curvature{20, 0, 0}}, {}};
  for (const std::string file : {"paper.yaml", "demo.yaml", "hot.yaml"}) {
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
      EXPECT_EQ(alarms(file, seed, seed % 2 == 0 ? flat : bent), 0u) << file << ", seed " << seed;
    }
  }
}

// Number of verdicts on a sheet without noise: at rest its taxels keep one code for minutes. The load acts in
// `pattern` only. A bent sheet reads a preload at rest, a flat one reads zero.
std::size_t quietAlarms(const fsr::simulation::LoadPattern& pattern, double curvature) {
  const fsr::simulation::SimulationSettings settings = fsr::simulation::withoutNoise(
      fsr::simulation::readSimulationFile(test_support::sourceDir() + "/config/simulation/demo.yaml"));
  fsr::simulation::SensorChain chain(settings);
  chain.mount({"sheet", 1, {fsr::matrix::Curvature{curvature, 0, 0}}, {}}, pattern);
  fsr::health::TaxelWatch watch(settings.layout.size, chain.fullScale());
  std::uint64_t number = 0;
  std::size_t found = 0;
  for (double time = 0; time < 2 * kCycle; time += 1 / kRate) {
    const double pressure = kPeak * 0.5 * (1 - std::cos(2 * M_PI * time / kCycle));
    watch.observe(chain.read({time, pressure, number++}).data(), time);
    for (const std::uint16_t flags : watch.flags()) found += flags != 0;
  }
  return found;
}

// Gas, and indenters with a straight edge or a round foot that leave a part of the sheet without load.
TEST(TaxelWatchAlarms, NoTaxelOfAQuietBoardIsCalledDeadOrStuckBesideALoad) {
  using fsr::simulation::LoadPattern;
  for (const double curvature : {0.0, 20.0}) {
    EXPECT_EQ(quietAlarms({}, curvature), 0u) << "gas";
    for (const double x : {-0.03, -0.018, -0.005, 0.0, 0.011, 0.02, 0.04}) {
      for (const double angle : {0.0, 0.5, M_PI / 4, M_PI / 2}) {
        EXPECT_EQ(quietAlarms({LoadPattern::Kind::kEdge, {x, x / 2}, 0, angle}, curvature), 0u)
            << "edge at " << x << " m, " << angle << " rad, curvature " << curvature;
      }
      for (const double radius : {0.012, 0.02, 0.033}) {
        EXPECT_EQ(quietAlarms({LoadPattern::Kind::kDisc, {x, x / 2}, radius, 0}, curvature), 0u)
            << "disc at " << x << " m, radius " << radius << " m, curvature " << curvature;
      }
    }
  }
}

// Point loads that saturate one taxel of a sheet at rest: 40 places x 250 windows, presses from 2 s to an
// hour. None flagged: the rate is below 3 / 10,000 windows = 3.0e-4 with 95 % confidence.
TEST(TaxelWatchAlarms, NoPointLoadIsCalledAShort) {
  constexpr fsr::matrix::MatrixSize kSize{7, 10};
  std::size_t found = 0;
  for (std::size_t place = 0; place < 40; ++place) {
    fsr::health::TaxelWatch watch(kSize, 4095);
    const std::size_t taxel = (place * 29) % kSize.taxels();
    const double press =
        std::min(3600.0, 2.0 * std::pow(1.22, double(place)));  // followed by an equally long pause [s]
    for (double time = 0; time < 2500; time += 0.2) {
      std::vector<std::uint16_t> counts(kSize.taxels(), static_cast<std::uint16_t>(3 + int(5 * time) % 3));
      if (std::fmod(time, 2 * press) < press) counts[taxel] = 4095;
      watch.observe(counts.data(), time);
      for (const std::uint16_t flags : watch.flags()) found += flags != 0;
    }
  }
  EXPECT_EQ(found, 0u);
}

// The opposite: a fault, one per sheet, is found within one and a half load cycles.
TEST(TaxelWatchAlarms, EachOfAHundredFaultsIsFoundWithinSeventySeconds) {
  for (std::uint64_t seed = 1; seed <= 25; ++seed) {
    for (const int fault : {0, 1, 2, 3}) {  // dead taxel, stuck taxel, short, broken row
      fsr::simulation::SimulationSettings settings =
          fsr::simulation::readSimulationFile(test_support::sourceDir() + "/config/simulation/demo.yaml");
      settings.seed = seed;
      fsr::simulation::SensorChain chain(settings);
      chain.mount({"flat", 1, {fsr::matrix::Curvature{}}, {}});
      fsr::health::TaxelWatch watch(settings.layout.size, chain.fullScale());
      const std::size_t taxel = (seed * 31 + 7) % 70;
      std::uint64_t number = 0;
      for (double time = 0; time < 1.5 * kCycle; time += 1 / kRate) {
        const double pressure = kPeak * 0.5 * (1 - std::cos(2 * M_PI * time / kCycle));
        std::vector<std::uint16_t> counts = chain.read({time, pressure, number++});
        for (std::size_t t = 0; t < 70; ++t) {
          if (fault == 3 ? t / 10 == taxel / 10 : t == taxel) {
            counts[t] = fault == 1 ? 812 : fault == 2 ? chain.fullScale() : 0;
          }
        }
        watch.observe(counts.data(), time);
      }
      EXPECT_NE(watch.flags()[taxel], 0) << "fault " << fault << ", seed " << seed;
    }
  }
}

}  // namespace
