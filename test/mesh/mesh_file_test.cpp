#include "mesh/mesh_file.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "fsr_pressure_map/settings/input_error.h"
#include "matrix/surface_file.h"
#include "mesh/example_meshes.h"
#include "mesh/mesh_surface.h"
#include "support/content_of.h"
#include "support/folder_test.h"
#include "support/holds.h"
#include "support/program_output.h"

namespace fsr::mesh {
namespace {

using test_support::kRadius;
using test_support::triangles;

constexpr double kInch = 0.0254;

class MeshFile : public test_support::FolderTest {
 protected:
  std::string written(const std::string& name, const std::string& text) const {
    std::ofstream(path(name)) << text;
    return path(name);
  }
  std::string refusal(const std::string& file) const {
    try {
      readMesh(file, 0.001);
    } catch (const settings::InputError& error) {
      const std::string sentence = error.what();
      EXPECT_EQ(sentence.rfind(file + ": ", 0), 0u) << sentence;
      return sentence.substr(file.size() + 2);
    }
    return "accepted";
  }
};

// Each file gives the connected mesh with the same curvature.
TEST_F(MeshFile, ReadsStlPlyAndObjAsTextAndBinary) {
  const std::vector<Point> corners = triangles(test_support::cylinder(kRadius));
  const Mesh right = weld(corners);
  test_support::writeAsciiStl(path("ascii.stl"), corners, 0.001);
  test_support::writeBinaryStl(path("binary.STL"), corners, 0.01);
  test_support::writePly(path("ascii.ply"), corners, 1, false);
  test_support::writePly(path("binary.ply"), corners, kInch, true);
  test_support::writeObj(path("mesh.obj"), corners, 0.001);
  SheetPlace place;
  place.layout.size = {7, 10};
  place.at = {kRadius, 0, 0};
  place.row_direction = {0, 1, 0};
  for (const auto& [name, unit] : std::vector<std::pair<std::string, double>>{{"ascii.stl", 0.001},
                                                                              {"binary.STL", 0.01},
                                                                              {"ascii.ply", 1},
                                                                              {"binary.ply", kInch},
                                                                              {"mesh.obj", 0.001}}) {
    const Mesh mesh = readMesh(path(name), unit);
    EXPECT_EQ(mesh.vertices.size(), right.vertices.size()) << name;
    EXPECT_EQ(mesh.triangles.size(), right.triangles.size()) << name;
    const MeshSurface surface = surfaceFromMesh(mesh, place, name);
    for (const matrix::Curvature& taxel : surface.surface.curvature)
      EXPECT_NEAR(taxel.x, 1 / kRadius, 0.02 / kRadius) << name;
  }
}

TEST_F(MeshFile, RefusesWhatIsNoMesh) {
  EXPECT_TRUE(test_support::holds(refusal(path("none.stl")), {"there is no such file"}));
  EXPECT_EQ(refusal(folder_).find("accepted"), std::string::npos);
  EXPECT_TRUE(test_support::holds(refusal(written("scan.txt", "hello")), {"\".txt\"", "ends with \".txt\""}));
  for (const char* name : {"empty.stl", "empty.ply", "empty.obj"})
    EXPECT_NE(refusal(written(name, "")), "accepted");
  for (const char* name : {"noise.stl", "noise.ply", "noise.obj"})
    EXPECT_NE(refusal(written(name, "no mesh at all, but a sentence about one")), "accepted");
  EXPECT_NE(refusal(written("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n")), "accepted");
  EXPECT_EQ(refusal(written("flat.obj", "v 0 0 0\nv 1 0 0\nv 1 0 0\nf 1 2 3\n")), "holds no triangles");
  EXPECT_EQ(refusal(written("nan.obj", "v 0 0 0\nv 1 0 0\nv 0 nan 0\nf 1 2 3\n")),
            "triangle 0 has a coordinate that is not a finite number");
}

// A file that was cut off must not pass for a mesh, nor end the program.
TEST_F(MeshFile, RefusesOrReadsATruncatedFile) {
  const std::vector<Point> corners = triangles(test_support::cylinder(kRadius), {0.005, 0.005});
  test_support::writeBinaryStl(path("whole.stl"), corners, 0.001);
  const std::string bytes = test_support::contentOf(path("whole.stl"));
  for (const std::size_t size :
       {std::size_t{10}, std::size_t{83}, std::size_t{84}, bytes.size() / 2, bytes.size() - 1})
    EXPECT_NE(refusal(written("cut.stl", bytes.substr(0, size))), "accepted") << size;
}

// What the package's own reader makes of the file that is written.
TEST_F(MeshFile, TheSurfaceFileIsReadBack) {
  SheetPlace place;
  place.layout = {{3, 4}, 0.010, 0.012};
  place.at = {kRadius, 0, 0};
  place.row_direction = {0, 1, 0.2};
  test_support::MeshOptions rough;
  rough.noise = 0.00005;
  const Mesh mesh = weld(triangles(test_support::cylinder(kRadius), rough));
  const MeshSurface surface = surfaceFromMesh(mesh, place, "limb");
  const MeshOrigin origin{"limb.stl", "scans/limb.stl", meshUnit("mm"), {50, 0, 0}, {0, 1, 0.2}, 1, 2};
  const matrix::Surface read =
      matrix::readSurfaceFile(written("limb.yaml", surfaceFileText(surface, place, origin)), {3, 4});
  EXPECT_EQ(read.name, "limb");
  ASSERT_EQ(read.curvature.size(), 12u);
  ASSERT_EQ(read.deviation.size(), 12u);
  for (std::size_t i = 0; i < 12; ++i) {
    EXPECT_NEAR(read.curvature[i].x, surface.surface.curvature[i].x, 5e-5);
    EXPECT_NEAR(read.curvature[i].xy, surface.surface.curvature[i].xy, 5e-5);
    EXPECT_NEAR(read.deviation[i], surface.surface.deviation[i], 5e-5);
    EXPECT_GT(read.deviation[i], 0);
  }
}

// The frame of the matrix has its origin in the middle of the sheet, x along the rows, y along the columns
// and z out of the loaded face; also in the wall, where z points to the axis.
TEST_F(MeshFile, TheSurfaceFilePlacesTheFrameOfTheMatrix) {
  const Mesh mesh = weld(triangles(test_support::cylinder(kRadius)));
  for (const bool outside : {true, false}) {
    SheetPlace place;
    place.layout = {{3, 3}, 0.010, 0.010};
    place.at = {kRadius, 0, 0};
    place.row_direction = {0, 1, 0.2};
    place.along_normals = outside;
    const MeshSurface made = surfaceFromMesh(mesh, place, "placed");
    const MeshOrigin origin{"a.stl", "../a.stl", meshUnit("mm"), place.at, place.row_direction, 1, 2};
    const auto read = matrix::readMeshPlaceFile(written("placed.yaml", surfaceFileText(made, place, origin)));
    ASSERT_TRUE(read);
    EXPECT_EQ(read->file, folder_.parent_path().string() + "/a.stl");
    EXPECT_EQ(read->unit, 0.001);
    const auto inMatrixFrame = [&](std::size_t taxel) {
      const auto& [x, y, z, w] = read->matrix.quaternion;
      const auto& [px, py, pz] = read->matrix.position;
      const Point& on_mesh = made.sheet.taxels[taxel].fit.frame.origin;
      return Point(Eigen::Quaterniond(w, x, y, z).conjugate() * (on_mesh - Point(px, py, pz)));
    };
    const double close = 0.05e-3;  // the fits of the walk and of the taxel differ [m]
    EXPECT_LT(inMatrixFrame(4).norm(), close);
    const double side = outside ? -1 : 1;  // the rows are nearly around the cylinder
    EXPECT_NEAR(inMatrixFrame(5).x(), 0.010, 0.1e-3);
    EXPECT_NEAR(inMatrixFrame(5).y(), 0, close);
    EXPECT_NEAR(inMatrixFrame(5).z(), side * 0.010 * 0.010 / (2 * kRadius), 0.1e-3);
    EXPECT_NEAR(inMatrixFrame(7).x(), 0, close);
    EXPECT_NEAR(inMatrixFrame(7).y(), 0.010, 0.1e-3);
  }
}

// The tool as a user starts it, in a shell without an environment.
class SurfaceFromMesh : public MeshFile {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(tool())) GTEST_SKIP() << tool() << " is not built (a build without ROS)";
    test_support::writeBinaryStl(path("socket.stl"), triangles(test_support::cylinder(kRadius)), 0.001);
  }
  static std::string tool() {
    return std::filesystem::canonical("/proc/self/exe").parent_path().string() + "/surface_from_mesh";
  }
  test_support::ProgramOutput run(const std::string& options) const {
    return test_support::outputOf("cd " + folder_.string() + " && env -i PATH=/usr/bin:/bin HOME=" +
                                  folder_.string() + " " + tool() + " " + options + " 2>&1");
  }
};

TEST_F(SurfaceFromMesh, WritesASurfaceFileAndSaysWhatItMeans) {
  const auto done =
      run("socket.stl --units mm --at 50,0,0 --row-direction 0,1,0 --side inside --output wall.yaml");
  EXPECT_EQ(done.status, 0) << done.text;
  EXPECT_NE(done.text.find("concave towards the load at every taxel"), std::string::npos) << done.text;
  EXPECT_NE(done.text.find("principal curvature of largest magnitude"), std::string::npos);
  EXPECT_NE(done.text.find("written: " + path("wall.yaml")), std::string::npos);
  EXPECT_EQ(matrix::readMeshPlaceFile(path("wall.yaml"))->file, path("socket.stl"));
  const matrix::Surface wall = matrix::readSurfaceFile(path("wall.yaml"), {7, 10});
  EXPECT_EQ(wall.name, "wall");
  EXPECT_NEAR(wall.curvature[33].x, -1 / kRadius, 0.02 / kRadius);
}

// rviz bends the sheet by the curvatures of the file. Every taxel must then be where the sheet was laid: on
// surfaces that wrinkle it, too, because both walk along the same lines.
TEST_F(SurfaceFromMesh, SaysHowFarTheDrawnSheetIsFromTheMesh) {
  const std::vector<std::pair<test_support::Surface, std::string>> cases = {
      {test_support::cylinder(kRadius), "50,0,0 --row-direction 0,1,0.2"},
      {test_support::cylinder(kRadius), "50,0,0 --row-direction 0,1,0.2 --side inside"},
      {test_support::sphere(0.08), "80,0,0 --row-direction 0,1,0"},
      {test_support::saddle(8, -6), "0,0,0 --row-direction 0,1,0"}};
  for (const auto& [surface, options] : cases) {
    test_support::writeBinaryStl(path("drawn.stl"), triangles(surface), 0.001);
    const auto done = run("drawn.stl --units mm --output drawn.yaml --columns 8 --at " + options);
    EXPECT_EQ(done.status, 0) << done.text;
    const std::string words = "rviz draws each taxel within ";
    const std::size_t at = done.text.find(words);
    ASSERT_NE(at, std::string::npos) << done.text;
    EXPECT_LT(std::stod(done.text.substr(at + words.size())), 0.05) << options;  // [mm]; seen 0.004 to 0.014
  }
}

TEST_F(SurfaceFromMesh, RefusesWrongOptionsInASentenceAndWritesNothing) {
  const std::string good = "socket.stl --units mm --at 50,0,0 --row-direction 0,1,0 --output wall.yaml";
  const auto replaced = [&](const std::string& from, const std::string& to) {
    std::string options = good;
    return options.replace(options.find(from), from.size(), to);
  };
  const std::vector<std::pair<std::string, std::string>> cases = {
      {replaced(" --units mm", ""), "--units"},
      {replaced("--units mm", "--units km"), "must be mm, cm, m or inch"},
      {replaced("--units mm", "--units m"), "check --units"},
      {replaced("--units mm", "--units inch"), "surface_from_mesh: socket.stl: "},
      {replaced("--at 50,0,0", "--at 50,0"), "must be three numbers"},
      {replaced("--at 50,0,0", "--at 70,0,0"), "--at is 20 mm from the mesh"},
      {replaced("0,1,0", "1,0,0"), "--row-direction is within 6 degrees"},
      {replaced("0,1,0", "0,0,0"), "must be a direction"},
      {good + " --columns 14", "is beside the mesh or in a hole of it"},
      {good + " --side top", "must be one of outside, inside"},
      {replaced("socket.stl", "none.stl"), "none.stl: there is no such file"},
      {replaced("--output wall.yaml", "--output socket.stl"), "socket.stl"},
      {replaced("--output wall.yaml", "--output none/wall.yaml"), "none"}};
  for (const auto& [options, part] : cases) {
    const auto done = run(options);
    EXPECT_NE(done.status, 0) << options;
    EXPECT_NE(done.text.find(part), std::string::npos) << options << '\n' << done.text;
    EXPECT_EQ(std::count(done.text.begin(), done.text.end(), '\n'), 1) << done.text;
    EXPECT_FALSE(std::filesystem::exists(path("wall.yaml"))) << options;
  }
}

}  // namespace
}  // namespace fsr::mesh
