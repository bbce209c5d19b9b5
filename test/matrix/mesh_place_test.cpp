#include "matrix/surface_file.h"

#include <unistd.h>

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "fsr_pressure_map/settings/input_error.h"

namespace fsr::matrix {
namespace {

const std::string kGood =
    "file: scan.stl\n  unit: 0.001\n  middle: [0.05, 0, 0.12]\n  row: [0, 1, 0]\n  normal: [1, 0, 0]\n";

settings::Settings surfaceWith(const std::string& mesh) {
  return settings::Settings::fromText("surface: limb\nflat: true\nmesh:\n  " + mesh, "/scans/limb.yaml");
}

std::string replaced(const std::string& from, const std::string& to) {
  std::string text = kGood;
  return text.replace(text.find(from), from.size(), to);
}

// Columns of the rotation matrix of a quaternion x, y, z, w.
std::array<double, 3> axisOf(const Pose& pose, int axis) {
  const auto& [x, y, z, w] = pose.quaternion;
  if (axis == 0) return {1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)};
  if (axis == 1) return {2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w)};
  return {2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)};
}

void expectNear(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], 1e-12) << i;
}

TEST(MeshPlace, IsTheFrameOfTheMatrixInThatOfTheMesh) {
  const auto place = readMeshPlace(surfaceWith(kGood));
  ASSERT_TRUE(place);
  EXPECT_EQ(place->file, "/scans/scan.stl");
  EXPECT_EQ(place->unit, 0.001);
  expectNear(place->matrix.position, {0.05, 0, 0.12});
  expectNear(axisOf(place->matrix, 0), {0, 1, 0});
  expectNear(axisOf(place->matrix, 1), {0, 0, 1});  // normal x row
  expectNear(axisOf(place->matrix, 2), {1, 0, 0});
}

TEST(MeshPlace, IsNothingWithoutAMesh) {
  EXPECT_FALSE(readMeshPlace(settings::Settings::fromText("surface: limb\nflat: true", "limb.yaml")));
}

TEST(MeshPlace, IsFoundBesideTheSurfaceFileUnlessItsPathIsAbsolute) {
  EXPECT_EQ(readMeshPlace(surfaceWith(replaced("scan.stl", "../a b/x.ply")))->file, "/a b/x.ply");
  EXPECT_EQ(readMeshPlace(surfaceWith(replaced("scan.stl", "/data/x.ply")))->file, "/data/x.ply");
}

// The origin of the mesh, seen from the matrix: 0.12 m back along the column, 0.05 m below the sheet.
TEST(MeshPlace, TheInverseIsTheMeshInTheFrameOfTheMatrix) {
  const Pose back = inverse(readMeshPlace(surfaceWith(kGood))->matrix);
  expectNear(back.position, {0, -0.12, -0.05});
  expectNear(axisOf(back, 0), {0, 0, 1});  // the mesh's x axis is the sheet's normal
  expectNear(inverse(back).position, {0.05, 0, 0.12});
}

TEST(MeshPlace, RefusesWrongValuesInOneSentence) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {replaced("0.12]", "0.12, 3]"), "must be a list of three numbers"},
      {replaced("[0, 1, 0]", "[0, 0.5, 0]"), "mesh.row is a list of 3, but must be a direction of length 1"},
      {replaced("[1, 0, 0]", "[0, 1, 0]"), "must be perpendicular to mesh.normal"},
      {replaced("unit: 0.001", "unit: 0"), "mesh.unit is 0"},
      {replaced("file: scan.stl", "file: ''"), "must be the name of the mesh"},
      {replaced("  unit: 0.001\n", ""), "mesh.unit"}};
  for (const auto& [text, part] : cases) {
    try {
      readMeshPlace(surfaceWith(text));
      ADD_FAILURE() << "accepted: " << text;
    } catch (const settings::InputError& error) {
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
      EXPECT_EQ(std::string(error.what()).rfind("/scans/limb.yaml: ", 0), 0u) << error.what();
    }
  }
}

TEST(MeshPlace, IsPartOfASurfaceFile) {
  const std::string path = testing::TempDir() + "mesh_place_test_" + std::to_string(::getpid()) + ".yaml";
  std::ofstream(path) << "surface: limb\nflat: true\nmesh:\n  " << kGood;
  EXPECT_EQ(readSurfaceFile(path, {2, 2}).name, "limb");
  EXPECT_TRUE(readMeshPlaceFile(path));
  std::ofstream(path) << "surface: limb\nflat: true\nmesh:\n  " << kGood << "  colour: red\n";
  EXPECT_THROW(readSurfaceFile(path, {2, 2}), settings::InputError);
  std::filesystem::remove(path);
}

Surface bent(double x, double y) {
  Surface surface;
  surface.curvature = {{x, y, 0}};
  return surface;
}

// A quarter round the limb is the direction y; the sheet's columns run along the axis.
TEST(OnLimb, PutsTheSheetAtTheRadiusOfItsSurface) {
  const Pose pose = onLimb(bent(20, 0), M_PI / 2, 0.1);
  expectNear(pose.position, {0, 0.05, 0.1});
  expectNear(axisOf(pose, 0), {-1, 0, 0});
  expectNear(axisOf(pose, 1), {0, 0, 1});
  expectNear(axisOf(pose, 2), {0, 1, 0});
}

TEST(OnLimb, TurnsTheLoadedFaceInwardsInASocket) {
  const Pose pose = onLimb(bent(-20, 0), M_PI / 2, 0);
  expectNear(pose.position, {0, 0.05, 0});
  expectNear(axisOf(pose, 1), {0, 0, 1});
  expectNear(axisOf(pose, 2), {0, -1, 0});
}

TEST(OnLimb, LaysTheRowsAlongTheAxisWhereTheColumnsAreBent) {
  const Pose pose = onLimb(bent(0, 10), 0, 0);
  expectNear(pose.position, {0.1, 0, 0});
  expectNear(axisOf(pose, 0), {0, 0, 1});
  expectNear(axisOf(pose, 2), {1, 0, 0});
}

TEST(OnLimb, PutsAFlatOrUnknownSheetAtSevenCentimetres) {
  expectNear(onLimb(bent(0, 0), 0, 0).position, {0.07, 0, 0});
  expectNear(onLimb(Surface(), 0, 0).position, {0.07, 0, 0});
}

}  // namespace
}  // namespace fsr::matrix
