#include "map/fill.h"

#include <gtest/gtest.h>

#include <cmath>

namespace fsr::map {
namespace {

PressureMap mapOf(matrix::MatrixSize size, const std::vector<float>& pressure, float deviation) {
  PressureMap map;
  map.reset({size});
  map.pressure = pressure;
  map.deviation.assign(size.taxels(), deviation);
  return map;
}

TEST(Fill, WeightsNeighboursByOneOverSquaredDistance) {
  PressureMap map = mapOf({3, 3}, {1, 2, 1, 2, NAN, 2, 1, 2, 1}, 0.0f);
  map.flags[4] = taxel_flag::kDead;
  fillFromNeighbours(map, {4});
  EXPECT_FLOAT_EQ(map.pressure[4], (4 * 2.0f + 4 * 0.5f * 1.0f) / 6.0f);
  EXPECT_EQ(map.flags[4], taxel_flag::kDead | taxel_flag::kFilled);
}

TEST(Fill, CombinesTheNeighboursDeviationAndTheirScatter) {
  PressureMap map = mapOf({1, 3}, {100, NAN, 300}, 30.0f);
  map.flags[1] = taxel_flag::kStuck;
  fillFromNeighbours(map, {1});
  EXPECT_FLOAT_EQ(map.pressure[1], 200.0f);
  EXPECT_FLOAT_EQ(map.deviation[1], std::sqrt(30.0f * 30.0f + 100.0f * 100.0f));
}

TEST(Fill, IgnoresBadAndFilledNeighbours) {
  PressureMap map = mapOf({1, 4}, {NAN, NAN, NAN, 40}, 1.0f);
  map.flags[0] = taxel_flag::kDead;
  map.flags[1] = taxel_flag::kMasked;
  map.flags[2] = taxel_flag::kStuck;
  fillFromNeighbours(map, {2, 0});
  EXPECT_FLOAT_EQ(map.pressure[2], 40.0f);
  EXPECT_TRUE(std::isnan(map.pressure[0]));
  EXPECT_EQ(map.flags[0], taxel_flag::kDead);
}

}  // namespace
}  // namespace fsr::map
