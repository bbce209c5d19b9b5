#include "mesh/mesh_file.h"

#include <gtest/gtest.h>

#include <cstring>

#include "fsr_pressure_map/settings/input_error.h"
#include "support/holds.h"

namespace fsr::mesh {
namespace {

using Corners = std::vector<Point>;

std::string refusal(Corners (*read)(const std::string&), const std::string& bytes) {
  return test_support::refusal([&] { read(bytes); }, "accepted");
}

template <typename Number>
std::string bigEndian(Number number) {
  std::string bytes(sizeof number, '\0');
  std::memcpy(bytes.data(), &number, sizeof number);
  return {bytes.rbegin(), bytes.rend()};
}

const Corners kSquare = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 0, 0}, {2, 2, 0}, {0, 2, 0}};

TEST(ObjFormat, CutsPolygonsAndCountsFromTheEnd) {
  const std::string vertices = "v 0 0 0\nv 2 0 0 1.0\r\nvn 0 0 1\nv 2 2 0\nv 0 2 0\n";
  EXPECT_EQ(objCorners(vertices + "f 1 2 3 4\n"), kSquare);
  EXPECT_EQ(objCorners("mtllib a.mtl\n# f 9\n" + vertices + "f 1/1/1 -3//1 3 -1"), kSquare);
  EXPECT_EQ(objCorners("f 1 2 3 4\n" + vertices), kSquare);  // vertices may follow
}

TEST(ObjFormat, RefusesWhatIsNoIndexOrNumber) {
  EXPECT_EQ(refusal(objCorners, "v 0 0 x\n"), "has \"x\" where a number must be");
  EXPECT_EQ(refusal(objCorners, "v 0 0 0\nv 0,5 0 0\n"), "has \"0,5\" where a number must be");
  EXPECT_TRUE(test_support::holds(refusal(objCorners, "v 0 0\n"), {"ends where a number must be"}));
  EXPECT_TRUE(
      test_support::holds(refusal(objCorners, "v 0 0 0\nf 1 1 0\n"), {"has a face with the vertex 0"}));
  EXPECT_NE(refusal(objCorners, "v 0 0 0\nf 1 1 -2\n"), "accepted");
  EXPECT_NE(refusal(objCorners, "v 0 0 0\nf 1 1 1.5\n"), "accepted");
  EXPECT_TRUE(
      test_support::holds(refusal(objCorners, "v 0 0 0\nf 1 1 2\n"), {"has a face with the vertex 1"}));
}

TEST(StlFormat, ReadsTextAndTheNamesOfSolids) {
  const std::string facet =
      "facet normal 0 0 1\n outer loop\n  vertex 0 0 0\n  vertex 2 0 0\n  vertex 2 2 0\n endloop\nendfacet\n";
  const Corners corners = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}};
  EXPECT_EQ(stlCorners("solid a vertex of endfacet\n" + facet + "endsolid a vertex\n"), corners);
  EXPECT_EQ(refusal(stlCorners, "solid a\n" + facet), "does not end with \"endsolid\", so it was cut off");
  EXPECT_EQ(refusal(stlCorners, "solid a\nvertex 0 0 0\nendfacet\nendsolid\n"),
            "has a facet that is no triangle");
}

TEST(StlFormat, SaysWhyBytesAreNoStlFile) {
  std::string bytes(84, ' ');
  bytes.replace(80, 4, std::string("\2\0\0\0", 4));
  EXPECT_TRUE(
      test_support::holds(refusal(stlCorners, bytes + "1234"), {"STL", "\"solid\"", "184 bytes", "88"}));
}

TEST(PlyFormat, ReadsWhatItNeedsOfAnyElement) {
  const std::string text =
      "ply\nformat ascii 1.0\ncomment end_header\nelement camera 1\nproperty list uchar float view\n"
      "element vertex 4\nproperty uchar red\nproperty double z\nproperty double x\nproperty double y\n"
      "element nothing 99999999999\nelement face 1\nproperty uchar quality\n"
      "property list uchar uint vertex_index\nend_header\n"
      "2 7 8\n1 0 0 0\n1 0 2 0\n1 0 2 2\n1 0 0 2\n5 4 0 1 2 3\n";
  EXPECT_EQ(plyCorners(text), kSquare);
}

TEST(PlyFormat, ReadsBothByteOrders) {
  std::string bytes =
      "ply\nformat binary_big_endian 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
      "property short z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
  for (const auto& [x, y] : {std::pair{0.0F, 0.0F}, {2.0F, 0.0F}, {2.0F, 2.0F}, {0.0F, 2.0F}})
    bytes += bigEndian(x) + bigEndian(y) + bigEndian(std::int16_t{0});
  bytes += '\4';
  for (const std::int32_t vertex : {0, 1, 2, 3}) bytes += bigEndian(vertex);
  EXPECT_EQ(plyCorners(bytes), kSquare);
  EXPECT_EQ(refusal(plyCorners, bytes.substr(0, bytes.size() - 1)),
            "ends before its last element, so it was cut off");
}

// Numbers that would take time or memory for ever if they were believed.
TEST(PlyFormat, RefusesCountsThatTheFileDoesNotHold) {
  const std::string head = "ply\nformat binary_little_endian 1.0\nelement vertex 4000000000000\n";
  EXPECT_NE(refusal(plyCorners, head + "property float x\nend_header\nabcdefgh"), "accepted");
  EXPECT_NE(refusal(plyCorners, head + "property list uint uchar x\nend_header\n\xFF\xFF\xFF\xFF"
                                       "a"),
            "accepted");
  EXPECT_EQ(refusal(plyCorners, head + "property float x\n"),
            "has a header without \"end_header\", so it was cut off");
  EXPECT_NE(refusal(plyCorners,
                    "ply\nformat ascii 1.0\nelement face 1\nproperty list int int "
                    "vertex_index\nend_header\n-1\n"),
            "accepted");
  EXPECT_NE(refusal(plyCorners, "plx\n"), "accepted");
  EXPECT_NE(refusal(plyCorners, "ply\nformat ascii 1.0\nproperty float x\nend_header\n"), "accepted");
  EXPECT_NE(refusal(plyCorners, "ply\nformat zip 1.0\nend_header\n"), "accepted");
}

}  // namespace
}  // namespace fsr::mesh
