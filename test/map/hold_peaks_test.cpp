#include <gtest/gtest.h>

#include <cmath>

#include "fsr_pressure_map/map/pressure_map.h"

namespace fsr::map {
namespace {

PressureMap mapOf(std::vector<float> pressure, std::vector<std::uint16_t> flags) {
  PressureMap map;
  map.layout.size = {1, static_cast<std::uint16_t>(pressure.size())};
  for (const float value : pressure) map.deviation.push_back(value / 10);
  map.pressure = std::move(pressure);
  map.flags = std::move(flags);
  return map;
}

TEST(HoldPeaks, KeepsTheHighestReadingOfEachTaxelWithItsFlags) {
  PressureMap peaks;
  holdPeaks(mapOf({100, 20, NAN}, {0, 0, taxel_flag::kDead}), peaks);
  holdPeaks(mapOf({50, 90, 30}, {taxel_flag::kTared, taxel_flag::kSaturated, 0}), peaks);
  peaks.state = MapState::kOk;
  holdPeaks(mapOf({NAN, NAN, NAN}, {taxel_flag::kMasked, taxel_flag::kDead, 0}), peaks);
  EXPECT_EQ(peaks.pressure, (std::vector<float>{100, 90, 30}));
  EXPECT_EQ(peaks.state, MapState::kUncalibrated);
  EXPECT_EQ(peaks.deviation, (std::vector<float>{10, 9, 3}));
  EXPECT_EQ(peaks.flags, (std::vector<std::uint16_t>{0, taxel_flag::kSaturated, 0}));
}

TEST(HoldPeaks, BeginsAnewWithAnotherMatrix) {
  PressureMap peaks;
  holdPeaks(mapOf({100, 20}, {0, 0}), peaks);
  holdPeaks(mapOf({5}, {0}), peaks);
  EXPECT_EQ(peaks.pressure, std::vector<float>{5});
}

}  // namespace
}  // namespace fsr::map
