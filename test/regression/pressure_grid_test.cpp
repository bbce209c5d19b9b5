#include "regression/grnn/weighted_codes.h"

#include <gtest/gtest.h>

namespace fsr::regression {
namespace {

TEST(PressureGrid, CoversEveryPressureWithAtMostTheGivenBins) {
  const std::vector<FixedPressure> pressure = {toFixed(-800.0), toFixed(0.0), toFixed(619e3)};
  const PressureGrid grid = pressureGrid(pressure, 64);
  EXPECT_LE(grid.bins, 64u);
  EXPECT_GT(grid.bins, 32u);
  EXPECT_EQ(grid.bin(pressure[0]), 0u);
  EXPECT_EQ(grid.bin(pressure[2]), grid.bins - 1);
  EXPECT_LE(grid.first, pressure[0]);
  EXPECT_EQ(grid.first % grid.width, 0);
  EXPECT_EQ(fromFixed(grid.width), 16384.0);  // [Pa]
}

TEST(PressureGrid, OnePressureIsOneBin) {
  const PressureGrid grid = pressureGrid({toFixed(5e3), toFixed(5e3)}, 64);
  EXPECT_EQ(grid.bins, 1u);
  EXPECT_EQ(grid.bin(toFixed(5e3)), 0u);
}

TEST(PressureGrid, WeightsAddUpToTheNumberOfSamplesInAnyOrder) {
  CodeSamples samples;
  samples.full_scale = 255;
  for (int i = 0; i < 30; ++i) samples.add(static_cast<std::uint16_t>(7 * i), toFixed(100.0 * i * i));
  for (int i = 0; i < 50; ++i) samples.add(3, toFixed(0.0));
  const WeightedCodes forward = weightedByPressure(samples);
  double total = 0;
  for (const double count : forward.count) total += count;
  EXPECT_NEAR(total, 80.0, 1e-9);
  EXPECT_EQ(forward.firstFrom(3), 1u);
  EXPECT_EQ(forward.firstFrom(-5), 0u);
  EXPECT_EQ(forward.firstFrom(1000), forward.code.size());

  std::reverse(samples.code.begin(), samples.code.end());
  std::reverse(samples.pressure.begin(), samples.pressure.end());
  const WeightedCodes backward = weightedByPressure(samples);
  EXPECT_EQ(backward.count, forward.count);
  EXPECT_EQ(backward.sum, forward.sum);
}

}  // namespace
}  // namespace fsr::regression
