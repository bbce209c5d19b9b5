#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "fsr_pressure_map/matrix/curvature.h"
#include "fsr_pressure_map/matrix/layout.h"
#include "matrix/surface_file.h"
#include "support/holds.h"
#include "support/source_dir.h"

namespace fsr::matrix {
namespace {

const MatrixSize kPaper{7, 10};

TEST(Layout, PutsTheOriginAtTheCentreWithColumnsAlongX) {
  const Layout layout{kPaper, 0.010, 0.012};
  const Position first = layout.position(layout.index(0, 0));
  EXPECT_DOUBLE_EQ(first.x, -0.045);
  EXPECT_DOUBLE_EQ(first.y, -0.036);
  EXPECT_DOUBLE_EQ(layout.position(layout.index(0, 9)).x, 0.045);
  EXPECT_DOUBLE_EQ(layout.position(layout.index(6, 0)).y, 0.036);
}

TEST(Layout, NumbersTaxelsRowByRow) {
  const Layout layout{kPaper};
  EXPECT_EQ(layout.index(2, 3).value, 23u);
  EXPECT_EQ(layout.row({23}), 2);
  EXPECT_EQ(layout.column({23}), 3);
}

TEST(Curvature, PrincipalIsTheOneOfLargestMagnitudeWithItsSign) {
  EXPECT_DOUBLE_EQ(principalCurvature({20, 0, 0}), 20);
  EXPECT_DOUBLE_EQ(principalCurvature({0, -20, 0}), -20);
  EXPECT_DOUBLE_EQ(principalCurvature({5, -9, 0}), -9);
  EXPECT_DOUBLE_EQ(principalCurvature({0, 0, 3}), 3);  // pure twist bends +3 and -3: the positive one
}

TEST(Curvature, PrincipalAgreesWithAnEigenSolver) {
  // python3 -c "import numpy as n; print(n.linalg.eigvalsh([[4,2.5],[2.5,-7]]))"  # numpy 1.24.2
  EXPECT_NEAR(principalCurvature({4, -7, 2.5}), -7.541522985, 1e-8);
}

TEST(Curvature, RefusesASurfaceOfAnotherMatrix) {
  Surface surface;
  EXPECT_NO_THROW(requireFit(surface, kPaper));
  surface.curvature.resize(70);
  EXPECT_NO_THROW(requireFit(surface, kPaper));
  surface.deviation.resize(160);
  EXPECT_THROW(requireFit(surface, kPaper), settings::InputError);
}

TEST(SurfaceFile, ACylinderWithItsAxisAlongYBendsTheRows) {
  const auto outside =
      settings::Settings::fromText("surface: c\ncylinder: {radius: 0.05, axis: y}", "c.yaml");
  const Surface surface = readSurface(outside, kPaper);
  ASSERT_EQ(surface.curvature.size(), 1u);
  EXPECT_DOUBLE_EQ(surface.curvature[0].x, 20.0);
  EXPECT_DOUBLE_EQ(surface.curvature[0].y, 0.0);
  const auto inside =
      settings::Settings::fromText("surface: c\ncylinder: {radius: 0.05, axis: x, side: inside}", "c.yaml");
  EXPECT_DOUBLE_EQ(readSurface(inside, kPaper).curvature[0].y, -20.0);
}

TEST(SurfaceFile, ReadsOneValueForEachTaxel) {
  const auto settings =
      settings::Settings::fromText("surface: limb\ntaxels: {x: [1, 2, 3, 4], xy: [0, 0, 0, 1]}", "limb.yaml");
  const Surface surface = readSurface(settings, {2, 2});
  EXPECT_EQ(surface.at({3}), (Curvature{4, 0, 1}));
}

TEST(SurfaceFile, ReadsOneDeviationForEachTaxelOrForAll) {
  const auto read = [](const std::string& text) {
    const auto settings = settings::Settings::fromText(text, "limb.yaml");
    const Surface surface = readSurface(settings, {1, 2});
    settings.refuseUnknown();
    return surface.deviation;
  };
  const std::string each = "surface: limb\ntaxels: {x: [1, 2], deviation: [0.3, 0.4]}";
  EXPECT_EQ(read(each), (std::vector<double>{0.3, 0.4}));
  EXPECT_EQ(read("surface: limb\ntaxels: {x: [1, 2]}\ndeviation: 0.5"), std::vector<double>{0.5});
  EXPECT_THROW(read(each + "\ndeviation: 0.5"), settings::InputError);
  EXPECT_THROW(read("surface: limb\ntaxels: {x: [1, 2], deviation: [0.3]}"), settings::InputError);
  EXPECT_THROW(read("surface: limb\ntaxels: {x: [1, 2], deviation: [0.3, -0.1]}"), settings::InputError);
}

TEST(SurfaceFile, RefusesTheWrongNumberOfTaxels) {
  const auto settings = settings::Settings::fromText("surface: limb\ntaxels: {x: [1, 2, 3]}", "limb.yaml");
  EXPECT_TRUE(test_support::holds(test_support::refusal([&] { readSurface(settings, kPaper); }),
                                  {"limb.yaml", "taxels.x", "70 taxels", "7 x 10"}));
}

TEST(SurfaceFile, RefusesTwoFormsAndTooLargeACurvature) {
  EXPECT_THROW(
      readSurface(settings::Settings::fromText("surface: c\nflat: true\ntwo_planes: {x: 1, y: 2}", "c"),
                  kPaper),
      settings::InputError);
  EXPECT_THROW(
      readSurface(settings::Settings::fromText("surface: c\ncylinder: {radius: 0.009, axis: y}", "c"),
                  kPaper),
      settings::InputError);
  EXPECT_THROW(readSurface(settings::Settings::fromText("surface: c", "c"), kPaper), settings::InputError);
}

TEST(SurfaceFile, AShippedSocketWallIsConcave) {
  const Surface wall =
      readSurfaceFile(test_support::sourceDir() + "/config/surfaces/socket_wall_5cm.yaml", kPaper);
  EXPECT_EQ(wall.curvature.front().x, -20.0);
}

TEST(SurfaceFile, EveryShippedSurfaceLoadsUnderItsFileName) {
  int files = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(test_support::sourceDir() + "/config/surfaces")) {
    const Surface surface = readSurfaceFile(entry.path().string(), kPaper);
    EXPECT_EQ(surface.name, entry.path().stem().string());
    ++files;
  }
  EXPECT_GE(files, 10);
}

}  // namespace
}  // namespace fsr::matrix
