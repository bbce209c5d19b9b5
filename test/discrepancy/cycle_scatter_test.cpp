// Scatter between cycles is a finding of its own: its size, its interval and its cost at the map.

#include "discrepancy/fit/cycle_noise.h"

#include <gtest/gtest.h>

#include <cmath>

#include "statistics/random_stream.h"

namespace fsr::discrepancy {
namespace {

// Cycles of 20 bins whose readings rise evenly to 40 % of full scale at 400 kPa.
CycleDesign evenDesign(std::size_t cycles) {
  CycleDesign design;
  design.cycle_time = 40;
  for (std::size_t c = 0; c < cycles; ++c) {
    CycleBins bins;
    const Eigen::Index n = 20;
    bins.net = Eigen::VectorXd::LinSpaced(n, 0.02, 0.4);
    bins.reading = bins.net;
    bins.pressure = 1e6 * bins.net;
    bins.slope = Eigen::VectorXd::Constant(n, 1e-6);
    bins.time = Eigen::VectorXd::LinSpaced(n, 0, 40);
    bins.white = Eigen::VectorXd::Constant(n, 1e-8);
    bins.corner = Eigen::VectorXd::Zero(n);
    bins.scans = Eigen::VectorXd::Ones(n);
    design.cycles.push_back(bins);
  }
  return design;
}

CycleNoise noiseWith(CycleNoise::Part part, double variance) {
  CycleNoise noise;
  noise.variance[part] = variance;
  return noise;
}

const Scatter& partOf(const std::vector<Scatter>& all, const std::string& part) {
  for (const Scatter& one : all) {
    if (one.part == part) return one;
  }
  ADD_FAILURE() << part;
  return all.front();
}

// 2 % of a pressure whose rms is 2 % of sqrt(mean(P^2)).
TEST(CycleScatter, OfTheGainIsASizeAndACostAtTheMap) {
  const CycleDesign design = evenDesign(30);
  const std::vector<Scatter> all = scatterOf(design, noiseWith(CycleNoise::kCycleGain, 4e-4));
  const Scatter& gain = partOf(all, "cycle_gain");
  EXPECT_NEAR(gain.size, 0.02, 1e-12);
  const double rms = std::sqrt(design.cycles[0].pressure.squaredNorm() / 20);
  EXPECT_NEAR(gain.at_map, 0.02 * rms, 1e-6);
  EXPECT_TRUE(gain.seen());
  EXPECT_GT(gain.of_noise, 0.99);
  EXPECT_FALSE(partOf(all, "cycle_offset").seen());
  EXPECT_FALSE(partOf(all, "wandering").seen());
}

// Thirty normal numbers: the standard deviation is known to 1 / sqrt(60) of itself.
TEST(CycleScatter, IntervalIsThatOfTheNumberOfCycles) {
  const Scatter gain =
      partOf(scatterOf(evenDesign(30), noiseWith(CycleNoise::kCycleGain, 4e-4)), "cycle_gain");
  const double relative = std::log(gain.interval.high / gain.interval.low) / (2 * 1.96);
  EXPECT_NEAR(relative, 1 / std::sqrt(60.0), 0.01);
  EXPECT_TRUE(scatterOf(evenDesign(2), {}).empty());
}

// Wandering has a variance of its own in the reading, and one that goes with the reading.
TEST(CycleScatter, OfWanderingAddsBothItsParts) {
  CycleNoise noise = noiseWith(CycleNoise::kSlow, 1e-6);
  noise.variance[CycleNoise::kWanderingGain] = 1e-4;
  const CycleDesign design = evenDesign(40);
  const Scatter wandering = partOf(scatterOf(design, noise), "wandering");
  EXPECT_NEAR(wandering.size, std::sqrt(1e-6 + 1e-4 * design.cycles[0].net.squaredNorm() / 20), 1e-9);
  EXPECT_TRUE(wandering.seen());
}

}  // namespace
}  // namespace fsr::discrepancy
