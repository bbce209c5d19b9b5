// Mounts are drawn from a known covariance; its family and its parameters are asked back.

#include "calibration/stages/shape/learn_shape.h"

#include <gtest/gtest.h>

#include <random>

#include "support/planted_shape.h"

namespace fsr::calibration {
namespace {

using test_support::PlantedShape;

// Mounts on surfaces of different gain and mean.
std::vector<SurfaceRests> restsOf(const PlantedShape& sheet, std::size_t surfaces) {
  std::mt19937 random(sheet.seed);
  std::vector<SurfaceRests> rests;
  for (std::size_t s = 0; s < surfaces; ++s) {
    SurfaceRests surface;
    surface.gain = 1 - 0.05 * double(s);
    surface.pressure = surface.gain * test_support::drawMounts(sheet, sheet.mounts, random);
    surface.pressure.array() += 10e3 * double(s);
    rests.push_back(surface);
  }
  return rests;
}

PlantedShape sheetOf(FieldFamily family, double deviation, double length, double common, double white,
                     unsigned seed) {
  PlantedShape sheet;
  sheet.scatter = test_support::scatterOf(family, deviation, length, common, white);
  sheet.seed = seed;
  return sheet;
}

// 24 contrasts tell a deviation to 1 / sqrt(2 x 24) = 14 % and more where neighbours move together; the
// factors are some three of these deviations.
TEST(LearnScatter, FindsThePlantedFamilyAndItsParameters) {
  for (const FieldFamily family : {FieldFamily::kMatern, FieldFamily::kGaussian}) {
    for (const double length : {0.02, 0.04}) {
      for (unsigned seed = 1; seed <= 3; ++seed) {
        const PlantedShape sheet = sheetOf(family, 3e3, length, 1e3, 100, seed);
        const MountScatter found = learnScatter(restsOf(sheet, 8), test_support::plantedPlaces(sheet));
        SCOPED_TRACE("seed " + std::to_string(seed) + ", length " + std::to_string(length));
        EXPECT_EQ(found.family, family);
        EXPECT_EQ(found.contrasts, 24u);
        EXPECT_GT(found.length, length / 1.6);
        EXPECT_LT(found.length, length * 1.6);
        EXPECT_GT(found.deviation, 3e3 / 1.6);
        EXPECT_LT(found.deviation, 3e3 * 1.6);
        EXPECT_LT(found.white, 400);
      }
    }
  }
}

// 8 surfaces with 20 mounts are 152 contrasts of 20 taxels: a deviation is known to 6 % and more.
TEST(LearnScatter, LearnsFromMoreMountsThanTaxels) {
  PlantedShape sheet = sheetOf(FieldFamily::kGaussian, 3e3, 0.03, 1e3, 100, 5);
  sheet.mounts = 20;
  const MountScatter found = learnScatter(restsOf(sheet, 8), test_support::plantedPlaces(sheet));
  EXPECT_EQ(found.family, FieldFamily::kGaussian);
  EXPECT_EQ(found.contrasts, 152u);
  EXPECT_NEAR(found.deviation, 3e3, 0.15 * 3e3);
  EXPECT_NEAR(found.length, 0.03, 0.1 * 0.03);
  EXPECT_NEAR(found.white, 100, 10);
}

TEST(LearnScatter, TellsScatterOfEachTaxelAloneFromAField) {
  const PlantedShape sheet = sheetOf(FieldFamily::kGaussian, 2e3, 0.04, 1e3, 1e3, 4);
  const MountScatter found = learnScatter(restsOf(sheet, 8), test_support::plantedPlaces(sheet));
  EXPECT_NEAR(found.white, 1e3, 150) << "480 values less the field: 4 %";
}

// The mean of a surface is not known, so the first mount of each tells nothing.
TEST(LearnScatter, LearnsNothingFromOneMountOfEachSurface) {
  PlantedShape sheet;
  sheet.mounts = 1;
  EXPECT_EQ(learnScatter(restsOf(sheet, 6), test_support::plantedPlaces(sheet)).contrasts, 0u);
}

TEST(LearnScatter, LeavesOutSurfacesWhoseReadingsAreCut) {
  const PlantedShape sheet;
  std::vector<SurfaceRests> rests = restsOf(sheet, 3);
  const MountScatter whole = learnScatter(rests, test_support::plantedPlaces(sheet));
  SurfaceRests cut = rests.front();
  cut.pressure *= 10;
  cut.zero_share = 0.03;
  rests.push_back(cut);
  const MountScatter same = learnScatter(rests, test_support::plantedPlaces(sheet));
  EXPECT_EQ(same.contrasts, whole.contrasts);
  EXPECT_EQ(same.deviation, whole.deviation);
}

}  // namespace
}  // namespace fsr::calibration
