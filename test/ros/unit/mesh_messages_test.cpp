#include "ros/messages/view_messages.h"

#include <gtest/gtest.h>

#include <cmath>

namespace fsr_ros {
namespace {

using visualization_msgs::Marker;

std_msgs::Header headerOf(const char* frame) {
  std_msgs::Header header;
  header.frame_id = frame;
  header.stamp = ros::Time(7);
  return header;
}

// The matrix lies 5 cm along the mesh's x axis and is turned by a quarter turn about z.
fsr::matrix::MeshPlace place() {
  const double half = std::sqrt(0.5);
  return {"/scans/left wall.stl", 0.001, {{0.05, 0, 0}, {0, 0, half, half}}};
}

TEST(MeshMessages, TheMarkerIsTheMeshInTheFrameOfTheMatrix) {
  const Marker marker = toMarker(headerOf("fsr_matrix"), place());
  EXPECT_EQ(marker.header.frame_id, "fsr_matrix");
  EXPECT_EQ(marker.type, Marker::MESH_RESOURCE);
  EXPECT_EQ(marker.action, Marker::ADD);
  EXPECT_EQ(marker.mesh_resource, "file:///scans/left%20wall.stl");
  EXPECT_EQ(marker.scale.x, 0.001);
  EXPECT_NEAR(marker.pose.position.x, 0, 1e-15);
  EXPECT_NEAR(marker.pose.position.y, 0.05, 1e-15);    // the sheet's y axis is the mesh's -x axis
  EXPECT_NEAR(marker.pose.position.z, -0.001, 1e-15);  // behind the sheet, so that it does not hide it
  EXPECT_NEAR(marker.pose.orientation.z, -std::sqrt(0.5), 1e-15);
  EXPECT_GT(marker.color.a, 0);
}

TEST(MeshMessages, ASurfaceWithoutAMeshDeletesTheMarker) {
  const Marker marker = noMesh(headerOf("fsr_matrix"));
  EXPECT_EQ(marker.action, Marker::DELETE);
  EXPECT_EQ(marker.ns, toMarker(headerOf("fsr_matrix"), place()).ns);
  EXPECT_EQ(marker.id, toMarker(headerOf("fsr_matrix"), place()).id);
}

TEST(MeshMessages, TheTransformIsTheMatrixInTheFrameOfTheMesh) {
  const geometry_msgs::TransformStamped transform =
      toTransform(headerOf("fsr_matrix"), "socket", place().matrix);
  EXPECT_EQ(transform.header.frame_id, "socket");
  EXPECT_EQ(transform.child_frame_id, "fsr_matrix");
  EXPECT_EQ(transform.transform.translation.x, 0.05);
  EXPECT_NEAR(transform.transform.rotation.z, std::sqrt(0.5), 1e-15);
}

TEST(MeshMessages, AUrlHasNoOtherCharactersThanAUrlMayHave) {
  EXPECT_EQ(fileUrl("/a/b-1_2.~x.stl"), "file:///a/b-1_2.~x.stl");
  EXPECT_EQ(fileUrl("/a b/\xC3\xA9#%.stl"), "file:///a%20b/%C3%A9%23%25.stl");
}

}  // namespace
}  // namespace fsr_ros
