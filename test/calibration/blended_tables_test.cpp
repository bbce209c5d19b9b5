#include <gtest/gtest.h>

#include <cmath>

#include "calibration/small_sheet.h"
#include "fsr_pressure_map/calibration/calibrator.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "support/allocation_guard.h"
#include "support/small_tables.h"

namespace fsr::calibration {
namespace {

using test_support::knownDeviation;
using test_support::knownPressure;
using test_support::smallTables;
namespace flag = map::taxel_flag;

constexpr std::size_t kTaxel = 7;

compensation::CurvatureTables tablesWith(compensation::BlendRule blend) {
  compensation::CurvatureTables tables = smallTables(kSize, {0.0, 10.0, 20.0});
  tables.rule.blend = blend;
  if (blend == compensation::BlendRule::kKernel) {
    tables.rule.length_scale = {4.0};
    for (regression::CodeTable& table : tables.tables) table.log_weight.assign(kFullScale + 1u, 0.0f);
  }
  return tables;
}

struct Reading {
  float pressure, deviation;
  std::uint16_t flags;
};

Reading read(Calibrator& calibrator, std::uint16_t code = 500) {
  const std::vector<std::uint16_t> counts(kSize.taxels(), code);
  map::PressureMap map;
  calibrator.calibrate({kSize, kFullScale, counts.data(), counts.size()}, 0, map);
  return {map.pressure[kTaxel], map.deviation[kTaxel], map.flags[kTaxel]};
}

TEST(BlendedTables, InterpolationGivesEveryCurvatureItsOwnTable) {
  Calibrator calibrator(tablesWith(compensation::BlendRule::kInterpolate), {kSize});
  for (const double curvature : {0.0, 2.0, 5.0, 10.0, 18.0, 20.0}) {
    calibrator.setSurface(bent(curvature), 0);
    // classes differ by 10 Pa
    EXPECT_NEAR(read(calibrator).pressure, knownPressure(kTaxel, 0, 500) + curvature, 0.01);
  }
}

TEST(BlendedTables, EachTaxelIsBlendedForItsOwnCurvature) {
  compensation::CurvatureTables tables = tablesWith(compensation::BlendRule::kInterpolate);
  tables.classes[1].curvature.assign(12, 10.0);
  tables.classes[1].curvature[kTaxel] = 4.0;  // trained on a limb
  Calibrator calibrator(tables, {kSize});
  matrix::Surface limb{"limb", 1, {}, {}};
  for (std::size_t taxel = 0; taxel < 12; ++taxel)
    limb.curvature.push_back({static_cast<double>(taxel), 0, 0});
  calibrator.setSurface(limb, 0);
  const std::vector<std::uint16_t> counts(12, 500);
  map::PressureMap map;
  calibrator.calibrate({kSize, kFullScale, counts.data(), 12}, 0, map);
  EXPECT_NEAR(map.pressure[3], knownPressure(3, 0, 500) + 3, 0.01);
  EXPECT_NEAR(map.pressure[11], knownPressure(11, 0, 500) + 11, 0.01);
  EXPECT_NEAR(map.pressure[kTaxel], knownPressure(kTaxel, 1, 500) + 10 * 3.0 / 16,
              0.01);  // 7 between 4 and 20 1/m
}

TEST(BlendedTables, InterpolationFlagsCurvaturesBetweenAndBeyondTheClasses) {
  Calibrator calibrator(tablesWith(compensation::BlendRule::kInterpolate), {kSize});
  calibrator.setSurface(bent(10.4), 0);
  EXPECT_EQ(read(calibrator).flags, 0);
  calibrator.setSurface(bent(10.6), 0);
  EXPECT_EQ(read(calibrator).flags, flag::kBetweenClasses);
  calibrator.setSurface(bent(-3), 0);
  EXPECT_EQ(read(calibrator).flags, flag::kCurvatureExtrapolated);
  EXPECT_EQ(read(calibrator).pressure, knownPressure(kTaxel, 0, 500));
}

TEST(BlendedTables, AnUnknownSurfaceUsesTheFlattestClass) {
  for (const compensation::BlendRule blend :
       {compensation::BlendRule::kNearest, compensation::BlendRule::kInterpolate}) {
    Calibrator calibrator(tablesWith(blend), {kSize});
    calibrator.setSurface(bent(13), 0);
    calibrator.setSurface({}, 0);
    EXPECT_EQ(read(calibrator).pressure, knownPressure(kTaxel, 0, 500));
  }
}

TEST(BlendedTables, KernelsAreBlendedOnAClass) {
  Calibrator calibrator(tablesWith(compensation::BlendRule::kKernel), {kSize});
  calibrator.setSurface(bent(0), 0);
  const double ten = std::exp(-100.0 / 32), twenty = std::exp(-400.0 / 32);  // weights of the classes
  const double expected = knownPressure(kTaxel, 0, 500) + (10 * ten + 20 * twenty) / (1 + ten + twenty);
  EXPECT_NEAR(read(calibrator).pressure, expected, 0.01);
}

TEST(BlendedTables, KernelsWithoutWeightsAreRefused) {
  compensation::CurvatureTables tables = tablesWith(compensation::BlendRule::kKernel);
  tables.tables[2].log_weight.clear();
  EXPECT_THROW(Calibrator(tables, {kSize}), settings::InputError);
}

TEST(BlendedTables, ByNameASurfaceUsesTheTableOfItsName) {
  Calibrator calibrator(tablesWith(compensation::BlendRule::kByName), {kSize});
  calibrator.setSurface(bent(0.3, "surface_2"), 0);
  EXPECT_EQ(read(calibrator).pressure, knownPressure(kTaxel, 2, 500));
  EXPECT_EQ(read(calibrator).flags, 0);
  calibrator.setSurface(bent(9.9, "another"), 0);
  EXPECT_EQ(read(calibrator).pressure, knownPressure(kTaxel, 1, 500));
  EXPECT_EQ(read(calibrator).flags, flag::kBetweenClasses);
}

TEST(BlendedTables, TheDeviationIsLargerOffTheCurvatureOfTheClass) {
  Calibrator calibrator(tablesWith(compensation::BlendRule::kNearest), {kSize});
  calibrator.setSurface(bent(9.7), 0);  // within the tolerance
  EXPECT_EQ(read(calibrator).deviation, knownDeviation(kTaxel, 1, 500));
  calibrator.setSurface(bent(6), 0);
  EXPECT_EQ(read(calibrator).pressure, knownPressure(kTaxel, 1, 500));
  compensation::CurvatureTables unsure = tablesWith(compensation::BlendRule::kNearest);
  unsure.rule.unseen = {{0}, {3e3}};
  Calibrator less_sure(unsure, {kSize});
  less_sure.setSurface(bent(6), 0);
  EXPECT_GT(read(less_sure).deviation, 3e3 * std::sqrt(4 * 0.6 * 0.4));
}

// Neighbouring classes differ by 10 Pa in 10 1/m: by 1 Pa in 1 1/m.
TEST(BlendedTables, AnUncertainCurvatureIsPartOfTheDeviation) {
  for (const compensation::BlendRule blend :
       {compensation::BlendRule::kNearest, compensation::BlendRule::kInterpolate,
        compensation::BlendRule::kByName}) {
    Calibrator calibrator(tablesWith(blend), {kSize});
    for (const double curvature : {0.0, 10.0, 20.0}) {
      matrix::Surface surface = bent(curvature);
      calibrator.setSurface(surface, 0);
      const Reading sure = read(calibrator);
      EXPECT_EQ(sure.deviation, knownDeviation(kTaxel, std::size_t(curvature / 10), 500));
      surface.deviation = {2000};
      calibrator.setSurface(surface, 1);
      EXPECT_NEAR(read(calibrator).deviation, std::hypot(sure.deviation, 2000.0), 0.5);
      EXPECT_EQ(read(calibrator).pressure, sure.pressure);
      EXPECT_EQ(read(calibrator).flags, sure.flags);
      surface.deviation.assign(kSize.taxels(), 0);
      surface.deviation[kTaxel] = 500;
      calibrator.setSurface(surface, 2);
      EXPECT_NEAR(read(calibrator).deviation, std::hypot(sure.deviation, 500.0), 0.5) << "of each taxel";
    }
  }
}

TEST(BlendedTables, WithOneClassAnUncertainCurvatureAddsNothing) {
  Calibrator calibrator(smallTables(kSize, {10.0}), {kSize});
  matrix::Surface surface = bent(10);
  surface.deviation = {5};
  calibrator.setSurface(surface, 0);
  EXPECT_EQ(read(calibrator).deviation, knownDeviation(kTaxel, 0, 500));
}

TEST(BlendedTables, ASmallStepOfCurvatureKeepsTheTable) {
  CalibratorOptions options;
  options.curvature_step = 0.1;
  Calibrator calibrator(tablesWith(compensation::BlendRule::kInterpolate), {kSize}, options);
  calibrator.setSurface(bent(5), 0);
  calibrator.setSurface(bent(5.09), 0);
  EXPECT_NEAR(read(calibrator).pressure, knownPressure(kTaxel, 0, 500) + 5, 0.01);
  calibrator.setSurface(bent(5.11), 0);
  EXPECT_NEAR(read(calibrator).pressure, knownPressure(kTaxel, 0, 500) + 5.11, 0.01);
}

TEST(BlendedTables, WorkAfterAMove) {
  Calibrator first(tablesWith(compensation::BlendRule::kInterpolate), {kSize});
  first.setSurface(bent(5), 0);
  Calibrator second(std::move(first));
  second.setSurface(bent(15), 0);
  EXPECT_NEAR(read(second).pressure, knownPressure(kTaxel, 0, 500) + 15, 0.01);
}

TEST(BlendedTables, AScanAllocatesNothingWithAnyRule) {
  for (const compensation::BlendRule blend :
       {compensation::BlendRule::kNearest, compensation::BlendRule::kKernel,
        compensation::BlendRule::kInterpolate}) {
    Calibrator calibrator(tablesWith(blend), {kSize});
    calibrator.setSurface(bent(5), 0);
    const std::vector<std::uint16_t> counts(kSize.taxels(), 500);
    map::PressureMap map;
    const matrix::ScanView scan{kSize, kFullScale, counts.data(), counts.size()};
    calibrator.calibrate(scan, 0, map);
    const test_support::AllocationGuard guard;
    calibrator.calibrate(scan, 0.1, map);
    EXPECT_EQ(guard.allocations(), 0u);
  }
}

}  // namespace
}  // namespace fsr::calibration
